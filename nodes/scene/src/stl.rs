use crate::{Mesh, MeshError};
use spatial::DVec3;

const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads an STL file, binary or text. The triangles share no vertices yet: see [`Mesh::welded`]. Normals are ignored:
/// the order of the corners says which side is out.
pub fn parse_stl(bytes: &[u8]) -> Result<Mesh, MeshError> {
    // The length decides: many binary files start with "solid" too.
    if let Some(count) = binary_count(bytes)
        && bytes.len() == HEADER + TRIANGLE * count
    {
        return binary(bytes, count);
    }
    match std::str::from_utf8(bytes) {
        Ok(text) if text.trim_start().starts_with("solid") => ascii(text),
        _ => Err(match binary_count(bytes) {
            Some(count) => MeshError::whole(format!(
                "not an STL file: {} bytes, where a binary one of {count} triangles has {}",
                bytes.len(),
                HEADER + TRIANGLE * count
            )),
            None => MeshError::whole("not an STL file: too short"),
        }),
    }
}

fn binary_count(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?;
    Some(u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize)
}

fn binary(bytes: &[u8], count: usize) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::default();
    for (i, record) in bytes[HEADER..].chunks_exact(TRIANGLE).enumerate() {
        let number = |k: usize| {
            let at = 12 + 4 * k;
            f64::from(f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]]))
        };
        for corner in 0..3 {
            let v = DVec3::new(number(3 * corner), number(3 * corner + 1), number(3 * corner + 2));
            if !v.is_finite() {
                return Err(MeshError::whole(format!("triangle {} has a number that is not finite", i + 1)));
            }
            mesh.vertices.push(v);
        }
        push_triangle(&mut mesh);
    }
    if count == 0 { Err(MeshError::whole("no triangles")) } else { Ok(mesh) }
}

fn ascii(text: &str) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::default();
    let mut corners = 0;
    for (line, number) in text.lines().zip(1u64..) {
        let mut words = line.split_whitespace();
        match words.next() {
            None | Some("solid" | "facet" | "outer" | "endloop" | "endsolid") => {}
            Some("vertex") => {
                let mut next = || match words.next().map(str::parse::<f64>) {
                    Some(Ok(x)) if x.is_finite() => Ok(x),
                    _ => Err(MeshError::at(number, "a vertex needs three finite numbers")),
                };
                let v = DVec3::new(next()?, next()?, next()?);
                mesh.vertices.push(v);
                corners += 1;
            }
            Some("endfacet") if corners == 3 => {
                push_triangle(&mut mesh);
                corners = 0;
            }
            Some("endfacet") => return Err(MeshError::at(number, format!("a facet of {corners} corners: need 3"))),
            Some(word) => return Err(MeshError::at(number, format!("unknown STL statement {word:.40?}"))),
        }
    }
    if corners != 0 {
        return Err(MeshError::whole("the last facet is cut off"));
    }
    if mesh.faces.is_empty() { Err(MeshError::whole("no triangles")) } else { Ok(mesh) }
}

/// Makes a triangle of the newest three vertices.
fn push_triangle(mesh: &mut Mesh) {
    let n = mesh.vertices.len() as u32;
    mesh.faces.push(vec![n - 3, n - 2, n - 1]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary_file(triangles: &[[f32; 9]]) -> Vec<u8> {
        let mut bytes = b"solid that is not text".to_vec();
        bytes.resize(80, 0);
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for t in triangles {
            bytes.extend([0; 12]);
            bytes.extend(t.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn binary_and_text_read_alike() {
        let from_binary = parse_stl(&binary_file(&[[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]])).unwrap();
        let text = "solid s\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0\n endloop\n endfacet\nendsolid s\n";
        assert_eq!(from_binary, parse_stl(text.as_bytes()).unwrap());
    }

    #[test]
    fn broken_files_are_refused_with_a_reason() {
        let good = binary_file(&[[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]]);
        assert!(parse_stl(&good[..good.len() - 1]).is_err());
        assert!(parse_stl(&good[..50]).is_err());
        assert!(parse_stl(&binary_file(&[])).is_err());
        assert!(parse_stl(&binary_file(&[[f32::NAN; 9]])).is_err());
        assert!(parse_stl(b"").is_err());
        assert_eq!(parse_stl(b"solid\nvertex 0 0\n").unwrap_err().line, Some(2));
        assert_eq!(parse_stl(b"solid\nvertex 0 0 0\nendfacet\n").unwrap_err().line, Some(3));
        assert!(parse_stl(b"solid\nvertex 0 0 0\n").is_err());
    }
}
