//! The program `cspace-haptics`.
fn main() {}
