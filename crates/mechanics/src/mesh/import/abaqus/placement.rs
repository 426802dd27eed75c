//! Where an assembly puts the mesh of a part: `*INSTANCE` with a translation, then a rotation about an axis along z.
//!
//! # References
//! Abaqus Keywords Reference Guide: `*PART`, `*INSTANCE`; Abaqus Analysis User's Guide, Assembly definition.

use std::collections::HashMap;

/// Share of the length of an axis across z up to which it counts as along z.
const ALONG_Z: f64 = 1e-6;

/// The parts of a file and their instances.
#[derive(Default)]
pub struct Assembly {
    instances: Vec<Instance>,
    contents: Vec<Contents>,
    /// The contents of the part or instance whose lines are read.
    open: Option<usize>,
}

/// What stands within a part or an instance.
struct Contents {
    /// The name of the part in capitals; `None` within an instance.
    part: Option<String>,
    nodes: Vec<u64>,
    has_elements: bool,
}

/// A part in the assembly.
struct Instance {
    name: String,
    part: String,
    /// The line of the file.
    line: usize,
    /// The index of what stands within it.
    contents: usize,
    translation: [f64; 3],
    rotation: Option<Rotation>,
}

/// A rotation about an axis along z.
struct Rotation {
    centre: [f64; 2],
    /// In degrees, counter-clockwise seen from positive z.
    angle: f64,
}

impl Assembly {
    /// Begins a part.
    pub fn begin_part(&mut self, name: &str) {
        self.begin(Some(name.to_uppercase()));
    }

    /// Begins an instance of a part.
    pub fn begin_instance(&mut self, name: &str, part: &str, line: usize) {
        let contents = self.begin(None);
        self.instances.push(Instance {
            name: name.to_owned(),
            part: part.to_uppercase(),
            line,
            contents,
            translation: [0.0; 3],
            rotation: None,
        });
    }

    /// Begins contents; returns their index.
    fn begin(&mut self, part: Option<String>) -> usize {
        let index = self.contents.len();
        self.contents.push(Contents {
            part,
            nodes: Vec::new(),
            has_elements: false,
        });
        self.open = Some(index);
        index
    }

    /// Ends a part or an instance.
    pub fn end(&mut self) {
        self.open = None;
    }

    /// Takes the numbers of a line below the keyword of an instance.
    ///
    /// # Errors
    /// A description of what places no sheet.
    pub fn place(&mut self, numbers: &[f64]) -> Result<(), String> {
        let Some(instance) = self.instances.last_mut() else {
            return Ok(());
        };
        match *numbers {
            [] => {}
            [ax, ay, az, bx, by, bz, angle] => {
                instance.rotation = rotation([ax, ay, az], [bx, by, bz], angle, &instance.name)?;
            }
            ref translation if translation.len() <= 3 => {
                instance.translation[..translation.len()].copy_from_slice(translation);
            }
            ref other => {
                return Err(format!(
                    "{} numbers place the instance `{}`: a translation has 3, a rotation 7",
                    other.len(),
                    instance.name
                ));
            }
        }
        Ok(())
    }

    /// Takes note of a node.
    pub fn add_node(&mut self, number: u64) {
        if let Some(open) = self.open {
            self.contents[open].nodes.push(number);
        }
    }

    /// Takes note of an element.
    pub fn add_element(&mut self) {
        if let Some(open) = self.open {
            self.contents[open].has_elements = true;
        }
    }

    /// Moves the nodes of the mesh to where its instance is.
    ///
    /// # Errors
    /// A description of a second instance with a mesh.
    pub fn put(&self, positions: &mut HashMap<u64, [f64; 3]>) -> Result<(), String> {
        let instances = self.instances.iter();
        let meshed: Vec<&Instance> = instances
            .filter(|instance| self.within(instance).any(|within| within.has_elements))
            .collect();
        let instance = match meshed[..] {
            [] => return Ok(()),
            [one] => one,
            [first, second, ..] => {
                return Err(format!(
                    "line {}: the instance `{}` is a mesh beside that of the instance `{}`, and a sheet is one mesh: merge the instances into one \
                     part (Merge/Cut Instances in Abaqus/CAE), or keep one of them",
                    second.line, second.name, first.name
                ));
            }
        };
        for number in self.within(instance).flat_map(|within| &within.nodes) {
            if let Some(position) = positions.get_mut(number) {
                *position = instance.moved(*position);
            }
        }
        Ok(())
    }

    /// What stands within an instance, and within its part.
    fn within<'a>(&'a self, instance: &'a Instance) -> impl Iterator<Item = &'a Contents> {
        let contents = self.contents.iter().enumerate();
        let is_of = move |index: usize, contents: &Contents| {
            index == instance.contents || contents.part.as_ref() == Some(&instance.part)
        };
        contents.filter_map(move |(index, contents)| is_of(index, contents).then_some(contents))
    }
}

impl Instance {
    /// The place of a point of the part: it is moved, then turned.
    fn moved(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [dx, dy, dz] = self.translation;
        let [x, y, z] = [x + dx, y + dy, z + dz];
        let Some(Rotation { centre, angle }) = &self.rotation else {
            return [x, y, z];
        };
        let [a, b] = [x - centre[0], y - centre[1]];
        let (sine, cosine) = sine_and_cosine(*angle);
        [
            centre[0] + cosine * a - sine * b,
            centre[1] + sine * a + cosine * b,
            z,
        ]
    }
}

/// The rotation by an angle in degrees about the axis from a to b; none where the angle is zero.
fn rotation(
    a: [f64; 3],
    b: [f64; 3],
    angle: f64,
    instance: &str,
) -> Result<Option<Rotation>, String> {
    if angle == 0.0 {
        return Ok(None);
    }
    let along = b[2] - a[2];
    let across = (b[0] - a[0]).hypot(b[1] - a[1]);
    if along == 0.0 || across > ALONG_Z * along.abs() {
        return Err(format!(
            "the instance `{instance}` is turned about an axis that is not along z: a sheet lies in the plane of x and y; place it there, or take the \
             mesh of its part alone"
        ));
    }
    Ok(Some(Rotation {
        centre: [a[0], a[1]],
        angle: angle * along.signum(),
    }))
}

/// Of an angle in degrees; without rounding at right angles.
fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let angle = angle.rem_euclid(360.0);
    match angle {
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => angle.to_radians().sin_cos(),
    }
}
