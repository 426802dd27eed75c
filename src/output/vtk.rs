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
use crate::finite_element::error_estimate::EnergyError;
use crate::mass_spring::{MassSpring, SpringState};
use crate::material::HyperelasticLaw;
use crate::material::sheet::Kinematics;
use crate::mesh::{CellShape, Mesh};

/// η_c/‖u_h‖ of each cell: the root of the sum of their squares is the error of the field in %.
const ESTIMATED_ERROR: &str = "estimated_error_percent_of_energy_norm";

/// What the stresses of a sheet follow from.
pub struct Sheet<'a> {
    /// The material.
    pub law: &'a dyn HyperelasticLaw,
    /// Thickness in mm.
    pub thickness: f64,
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

impl Array {
    /// The difference of a displacement field to the finite elements' at the same nodes.
    pub fn difference(displacement: &[f64], reference: &[f64]) -> Self {
        let pairs = displacement.iter().zip(reference);
        Self {
            name: TO_FINITE_ELEMENTS,
            values: pairs.map(|(u, v)| u - v).collect(),
            components: 2,
        }
    }
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
