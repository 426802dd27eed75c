//! Studies that are exported to other codes, and what `gelbench compare` says of their fields.

/// A plate on few finite elements.
pub const PLATE: &str = "[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\ncells = [12, 4]\n[material]\ncard = \"neo-hooke\"\n\
    [load]\nstretches = [\"20 %\", \"50 %\"]\n[finite_element]\ncells = [12, 4]\n";

/// A strip with a hole, clamped on the left.
pub const HOLE: &str = "kind = \"specimen\"\ntitle = \"hole\"\n[material]\ncard = \"treloar-ogden-3\"\n[specimen]\n\
    shape = \"strip-with-hole\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\nthickness = \"2 mm\"\ncells = 4\n\
    [path]\nfactors = [0.5, 1.0]\nmeasured_group = \"left\"\n\
    [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n";

/// A displacement of its right side.
pub const PULLED: &str =
    "[[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"10 mm\"\ny = \"0 mm\"\n";

/// A force on its right side.
pub const GRIPPED: &str =
    "[[support]]\ngroup = \"right\"\nkind = \"grip\"\nx_force = \"4 N\"\ny = \"0 mm\"\n";

/// Finite elements that refine themselves.
pub const ADAPTIVE: &str = "[finite_element]\nelement = \"T2\"\nadaptive = true\nerror = \"2 %\"\n";

/// Deviation of the finite elements in % from what `gelbench compare` prints.
pub fn deviation(printed: &str) -> f64 {
    let line = printed
        .lines()
        .find(|line| line.starts_with("finite elements"));
    let word = line.and_then(|line| line.split_whitespace().nth(2));
    word.and_then(|word| word.parse().ok())
        .unwrap_or_else(|| panic!("{printed}"))
}
