//! VTK files: one `.vtu` a stretch and model, and a `.pvd` a model that plays the stretches.
//!
//! Units are part of the arrays' names. Stresses and what belongs to them are those of the material at
//! the field's gradient in the centre of each cell; tensors have nine components, row by row, and the
//! nominal stress is Pᵀ: its first index is the reference direction.

use nalgebra::Vector4;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataArray, DataSet, ElementType, IOBuffer,
    UnstructuredGridPiece, Version, VertexNumbers, Vtk,
};

use super::wrinkling::Wrinkling;
use crate::corrector::Multipliers;
use crate::corrector::plate::{EQUILIBRIUM, FREE_EDGES, GRIPS};
use crate::finite_element::error_estimate::EnergyError;
use crate::mass_spring::{MassSpring, SpringState};
use crate::material::HyperelasticLaw;
use crate::material::sheet::Kinematics;
use crate::mesh::{CellShape, Mesh};
use crate::problem::Problem;
use crate::results::Results;
use crate::study::Study;

/// η_c/‖u_h‖ of each cell: the root of the sum of their squares is the error of the field in %.
const ESTIMATED_ERROR: &str = "estimated_error_percent_of_energy_norm";

/// All VTK files of a run: name and content, one after the other; those of a model as far as it has solutions.
pub fn files(study: &Study, results: &Results) -> impl Iterator<Item = (String, Vec<u8>)> {
    let model = move |model: Model| {
        let steps = 0..study.problem.stretches.len();
        let steps: Vec<usize> = steps.filter(|step| model.has(results, *step)).collect();
        let stretch = |step: &usize| (study.problem.stretches[*step], model.file_name(*step));
        let named: Vec<_> = steps.iter().map(stretch).collect();
        let collection =
            (!named.is_empty()).then(|| (format!("{}.pvd", model.name()), collection(&named)));
        let grids = steps.into_iter().filter_map(move |step| {
            let grid = model.grid(study, results, step)?;
            Some((model.file_name(step), encode(&study.title, grid)))
        });
        grids.chain(collection)
    };
    Model::ALL.into_iter().flat_map(model)
}

#[derive(Clone, Copy)]
enum Model {
    MassSpring,
    Springs,
    Corrected,
    FiniteElement,
}

impl Model {
    const ALL: [Self; 4] = [
        Self::MassSpring,
        Self::Springs,
        Self::Corrected,
        Self::FiniteElement,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::MassSpring => "mass_spring",
            Self::Springs => "springs",
            Self::Corrected => "corrected",
            Self::FiniteElement => "finite_element",
        }
    }

    fn file_name(self, step: usize) -> String {
        format!("{}_{:03}.vtu", self.name(), step + 1)
    }

    fn has(self, results: &Results, step: usize) -> bool {
        let [springs, corrected, elements] = results.models(step).map(|model| model.is_some());
        match self {
            Self::MassSpring | Self::Springs => springs,
            Self::Corrected => corrected,
            Self::FiniteElement => elements,
        }
    }

    /// The grid at a stretch at which the model has a solution.
    fn grid(self, study: &Study, results: &Results, step: usize) -> Option<UnstructuredGridPiece> {
        let sheet = &(&study.problem).into();
        let lattice = &results.springs.mesh;
        let reference = results.reference_on_lattice.get(step);
        let difference =
            |u: &[f64]| reference.map(|reference| difference(TO_FINITE_ELEMENTS, u, reference));
        let [springs, _, elements] = results.models(step);
        Some(match self {
            Self::MassSpring => {
                let u = &springs?.displacement;
                plate(sheet, lattice, u, difference(u).into_iter().collect(), None)
            }
            Self::Corrected => {
                let state = results.corrected[step].as_ref()?;
                let u = &state.solution.displacement;
                let multipliers = state.multipliers.iter();
                let arrays = multipliers.filter_map(|group| multiplier_array(group, u.len()));
                let all = difference(u).into_iter().chain(arrays).collect();
                plate(sheet, lattice, u, all, None)
            }
            Self::FiniteElement => {
                let estimate = results.estimates[step].as_ref();
                plate(
                    sheet,
                    &results.finest().model.mesh,
                    &elements?.displacement,
                    Vec::new(),
                    estimate.map(|estimate| &estimate.energy),
                )
            }
            Self::Springs => self::springs(&results.springs, &springs?.displacement),
        })
    }
}

/// What the stresses of a sheet follow from.
pub struct Sheet<'a> {
    /// The material.
    pub law: &'a dyn HyperelasticLaw,
    /// Thickness in mm.
    pub thickness: f64,
}

impl<'a> From<&'a Problem> for Sheet<'a> {
    fn from(problem: &'a Problem) -> Self {
        Self {
            law: &*problem.law,
            thickness: problem.thickness,
        }
    }
}

/// The `.vtu` file of a displacement field on a mesh, with the stresses that follow and the difference to a reference
/// field at the nodes, where there is one.
pub fn field_file(
    title: &str,
    sheet: &Sheet,
    mesh: &Mesh,
    displacement: &[f64],
    reference: Option<&[f64]>,
) -> Vec<u8> {
    let difference =
        reference.map(|reference| difference(TO_FINITE_ELEMENTS, displacement, reference));
    let more = difference.into_iter().collect();
    encode(title, plate(sheet, mesh, displacement, more, None))
}

/// The `.vtu` file of a moving sheet at one instant: displacement in mm, velocity in mm/s, the stresses of the elastic
/// material, and the difference to a reference field at the nodes, where there is one.
pub fn moving_file(
    title: &str,
    sheet: &Sheet,
    mesh: &Mesh,
    [displacement, velocity]: [&[f64]; 2],
    reference: Option<&[f64]>,
) -> Vec<u8> {
    let velocity = planar_vectors("velocity_mm_per_s", velocity);
    let reference =
        reference.map(|reference| difference(TO_FINITE_ELEMENTS, displacement, reference));
    let more = [velocity].into_iter().chain(reference).collect();
    encode(title, plate(sheet, mesh, displacement, more, None))
}

/// The `.vtu` file of a finite-element field, with the stresses that follow and its estimated error.
pub fn finite_element_file(
    title: &str,
    sheet: &Sheet,
    mesh: &Mesh,
    displacement: &[f64],
    error: &EnergyError,
) -> Vec<u8> {
    encode(
        title,
        plate(sheet, mesh, displacement, Vec::new(), Some(error)),
    )
}

/// The `.vtu` file of a displacement field on a mesh beside an imported one at the same nodes.
pub fn imported_file(
    title: &str,
    sheet: &Sheet,
    mesh: &Mesh,
    displacement: &[f64],
    imported: &[f64],
) -> Vec<u8> {
    let more = vec![
        planar_vectors("imported_displacement_mm", imported),
        difference(TO_IMPORTED, displacement, imported),
    ];
    encode(title, plate(sheet, mesh, displacement, more, None))
}

/// An array for a file.
#[derive(Clone, Debug)]
pub struct Array {
    /// Its name with the unit.
    pub name: &'static str,
    /// Its values.
    pub values: Vec<f64>,
    /// How many belong to one point or cell: 1, 2 (x, y) or 4 (xx, xy, yx, yy).
    pub components: usize,
}

impl From<Array> for Attribute {
    fn from(given: Array) -> Self {
        match given.components {
            1 => array(given.name, scalars(), given.values),
            2 => planar_vectors(given.name, &given.values),
            _ => {
                let planar = given.values.chunks_exact(4);
                let whole = planar.flat_map(|t| [t[0], t[1], 0.0, t[2], t[3], 0.0, 0.0, 0.0, 0.0]);
                array(given.name, ElementType::Tensors, whole.collect())
            }
        }
    }
}

/// The `.vtu` file of a displacement field on a mesh with more arrays at its nodes and in its cells.
pub fn arrays_file(
    title: &str,
    sheet: &Sheet,
    mesh: &Mesh,
    displacement: &[f64],
    at_nodes: Vec<Array>,
    in_cells: Vec<Array>,
) -> Vec<u8> {
    let at_nodes = at_nodes.into_iter().map(Attribute::from).collect();
    let mut grid = plate(sheet, mesh, displacement, at_nodes, None);
    let in_cells = in_cells.into_iter().map(Attribute::from);
    grid.data.cell.extend(in_cells);
    encode(title, grid)
}

/// The `.vtu` file of scattered points with a displacement field and an imported one at them.
pub fn points_file(
    title: &str,
    places: &[[f64; 2]],
    displacement: &[f64],
    imported: &[f64],
) -> Vec<u8> {
    let arrays = vec![
        planar_vectors("displacement_mm", displacement),
        planar_vectors("imported_displacement_mm", imported),
        difference(TO_IMPORTED, displacement, imported),
    ];
    encode(title, scattered(places, arrays))
}

/// The `.vtu` file of scattered points with arrays at them.
pub fn markers_file(title: &str, places: &[[f64; 2]], arrays: Vec<Array>) -> Vec<u8> {
    let arrays = arrays.into_iter().map(Attribute::from).collect();
    encode(title, scattered(places, arrays))
}

fn scattered(places: &[[f64; 2]], arrays: Vec<Attribute>) -> UnstructuredGridPiece {
    let nodes: Vec<usize> = (0..places.len()).collect();
    let cells: Vec<&[usize]> = nodes.chunks(1).collect();
    UnstructuredGridPiece {
        points: IOBuffer::F64(places.iter().flat_map(|[x, y]| [*x, *y, 0.0]).collect()),
        cells: connect(&cells, vec![CellType::Vertex; cells.len()]),
        data: Attributes {
            point: arrays,
            cell: Vec::new(),
        },
    }
}

const TO_FINITE_ELEMENTS: &str = "difference_to_finite_elements_mm";
const TO_IMPORTED: &str = "difference_to_imported_mm";

fn difference(name: &str, displacement: &[f64], reference: &[f64]) -> Attribute {
    let pairs = displacement.iter().zip(reference);
    let difference: Vec<f64> = pairs.map(|(u, v)| u - v).collect();
    planar_vectors(name, &difference)
}

/// The `.vtu` file of the springs of a lattice.
pub fn springs_file(title: &str, model: &MassSpring, displacement: &[f64]) -> Vec<u8> {
    encode(title, springs(model, displacement))
}

/// A plate's cells with the fields that follow from its displacement.
fn plate(
    sheet: &Sheet,
    mesh: &Mesh,
    displacement: &[f64],
    more_point_data: Vec<Attribute>,
    error: Option<&EnergyError>,
) -> UnstructuredGridPiece {
    let cells: Vec<&[usize]> = (0..mesh.cell_count()).map(|cell| mesh.cell(cell)).collect();
    let kinds = (0..mesh.cell_count()).map(|cell| kind(mesh.shape(cell)));
    let mut point = vec![planar_vectors("displacement_mm", displacement)];
    point.extend(more_point_data);
    let mut cell = material_state(sheet, mesh, displacement);
    cell.extend(error.map(|error| array(ESTIMATED_ERROR, scalars(), error.cell_percents())));
    UnstructuredGridPiece {
        points: points(mesh),
        cells: connect(&cells, kinds.collect()),
        data: Attributes { point, cell },
    }
}

fn kind(shape: CellShape) -> CellType {
    match shape {
        CellShape::Triangle3 => CellType::Triangle,
        CellShape::Triangle6 => CellType::QuadraticTriangle,
        CellShape::Quad4 => CellType::Quad,
        CellShape::Quad8 => CellType::QuadraticQuad,
        CellShape::Quad9 => CellType::BiquadraticQuad,
    }
}

fn material_state(sheet: &Sheet, mesh: &Mesh, displacement: &[f64]) -> Vec<Attribute> {
    let (mut nominal, mut cauchy, mut stretches) = (Vec::new(), Vec::new(), Vec::new());
    let (mut i1, mut thickness, mut energy) = (Vec::new(), Vec::new(), Vec::new());
    for cell in 0..mesh.cell_count() {
        let gradient = mesh.gradient_at(displacement, cell, mesh.shape(cell).centre());
        let kinematics = Kinematics::new(&Vector4::from(gradient))
            .expect("cells with positive corners have a positive centre");
        let (density, p) = sheet.law.stress(&kinematics);
        nominal.extend([p[0], p[2], 0.0, p[1], p[3], 0.0, 0.0, 0.0, 0.0]);
        let [s11, s12, s22] = kinematics.cauchy_stress(&p);
        cauchy.extend([s11, s12, 0.0, s12, s22, 0.0, 0.0, 0.0, 0.0]);
        stretches.extend(kinematics.principal_stretches());
        i1.push(3.0 + kinematics.invariants.i1_minus_3);
        thickness.push(sheet.thickness / kinematics.area_ratio());
        energy.push(density);
    }
    let wrinkling = Wrinkling::new(sheet.law, mesh, displacement);
    let compressed = wrinkling.compressed.iter();
    let compressed = compressed.map(|is| f64::from(u8::from(*is))).collect();
    vec![
        array("nominal_stress_MPa", ElementType::Tensors, nominal),
        array("cauchy_stress_MPa", ElementType::Tensors, cauchy),
        array(
            "smallest_principal_cauchy_stress_MPa",
            scalars(),
            wrinkling.smallest,
        ),
        array("wrinkling_1", scalars(), compressed),
        array("principal_stretches_1", ElementType::Vectors, stretches),
        array("first_invariant_I1_1", scalars(), i1),
        array("thickness_mm", scalars(), thickness),
        array("energy_density_mJ_per_mm3", scalars(), energy),
    ]
}

fn springs(model: &MassSpring, displacement: &[f64]) -> UnstructuredGridPiece {
    let cells: Vec<&[usize]> = model
        .springs
        .iter()
        .map(|spring| &spring.nodes[..])
        .collect();
    let states = model.spring_states(displacement);
    let of = |value: fn(&SpringState) -> f64| states.iter().map(value).collect();
    UnstructuredGridPiece {
        points: points(&model.mesh),
        cells: connect(&cells, vec![CellType::Line; cells.len()]),
        data: Attributes {
            point: vec![planar_vectors("displacement_mm", displacement)],
            cell: vec![
                array("force_N", scalars(), of(|state| state.force)),
                array("stretch_1", scalars(), of(|state| state.stretch)),
            ],
        },
    }
}

/// The multipliers of a condition at the nodes; zero where the condition does not hold.
fn multiplier_array(group: &Multipliers, size: usize) -> Option<Attribute> {
    let name = match group.name.as_str() {
        EQUILIBRIUM => "multiplier_zeta_equilibrium_mm2_per_N",
        GRIPS => "multiplier_eta_grips_mm",
        FREE_EDGES => "multiplier_eta_free_edges_mm2_per_N",
        _ => return None,
    };
    let mut values = vec![0.0; size];
    for (unknown, value) in group.unknowns.iter().flatten().zip(&group.values) {
        values[*unknown] = *value;
    }
    Some(planar_vectors(name, &values))
}

fn points(mesh: &Mesh) -> IOBuffer {
    let nodes = mesh.nodes.iter();
    IOBuffer::F64(nodes.flat_map(|[x, y]| [*x, *y, 0.0]).collect())
}

fn connect(cells: &[&[usize]], types: Vec<CellType>) -> Cells {
    let ends = cells.iter().scan(0, |end, cell| {
        *end += cell.len() as u64;
        Some(*end)
    });
    Cells {
        types,
        cell_verts: VertexNumbers::XML {
            connectivity: cells
                .iter()
                .flat_map(|cell| cell.iter().map(|node| *node as u64))
                .collect(),
            offsets: ends.collect(),
        },
    }
}

fn scalars() -> ElementType {
    ElementType::Scalars {
        num_comp: 1,
        lookup_table: None,
    }
}

/// x, y of node after node as vectors with z = 0.
fn planar_vectors(name: &str, values: &[f64]) -> Attribute {
    let vectors = values.chunks_exact(2).flat_map(|v| [v[0], v[1], 0.0]);
    array(name, ElementType::Vectors, vectors.collect())
}

fn array(name: &str, elem: ElementType, values: Vec<f64>) -> Attribute {
    Attribute::DataArray(DataArray {
        name: name.to_owned(),
        elem,
        data: IOBuffer::F64(values),
    })
}

fn encode(title: &str, grid: UnstructuredGridPiece) -> Vec<u8> {
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: title.to_owned(),
        byte_order: ByteOrder::LittleEndian,
        data: DataSet::inline(grid),
        file_path: None,
    };
    let mut bytes = Vec::new();
    file.write_xml(&mut bytes)
        .expect("a grid with matching arrays can be written to memory");
    bytes
}

/// ParaView's collection of files, with the stretch or the load factor as their times.
pub fn collection(files: &[(f64, String)]) -> Vec<u8> {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    let steps = files.iter();
    let data_set = |writer: &mut Writer<Vec<u8>>, (time, file): &(f64, String)| {
        let time = time.to_string();
        let attributes = [
            ("timestep", time.as_str()),
            ("part", "0"),
            ("file", file.as_str()),
        ];
        writer
            .create_element("DataSet")
            .with_attributes(attributes)
            .write_empty()
            .map(|_| ())
    };
    let document = |writer: &mut Writer<Vec<u8>>| {
        writer.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
        let attributes = [("type", "Collection"), ("version", "0.1")];
        let file = writer.create_element("VTKFile").with_attributes(attributes);
        file.write_inner_content(|writer| {
            let collection = writer.create_element("Collection");
            collection.write_inner_content(|writer| {
                steps.clone().try_for_each(|step| data_set(writer, step))
            })?;
            Ok(())
        })?;
        Ok::<(), std::io::Error>(())
    };
    document(&mut writer).expect("writing to memory does not fail");
    writer.into_inner()
}
