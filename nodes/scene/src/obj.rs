use crate::{Mesh, MeshError};
use spatial::DVec3;

/// Statements that say nothing about the surface: texture, normals, names, materials, loose points and lines.
const IGNORED: &[&str] = &[
    "vt",
    "vn",
    "vp",
    "o",
    "g",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "l",
    "p",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
];

/// Reads a Wavefront OBJ text: `v` and `f` statements, indices from 1 or counted back from the newest vertex.
/// Every error names its line. Curves and surfaces (`curv`, `surf`, ...) are refused, not skipped.
pub fn parse_obj(text: &str) -> Result<Mesh, MeshError> {
    parse_obj_with_lines(text).map(|(mesh, _)| mesh)
}

/// Where a mesh's parts stand in its file, lines from 1: so that what is found wrong later can still name its line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ObjLines {
    /// The line of each vertex.
    pub vertices: Vec<u64>,
    /// The line of each face.
    pub faces: Vec<u64>,
}

/// [`parse_obj`], with the line of every vertex and face.
pub fn parse_obj_with_lines(text: &str) -> Result<(Mesh, ObjLines), MeshError> {
    let mut mesh = Mesh::default();
    let mut lines = ObjLines::default();
    for (line, statement) in statements(text) {
        let mut words = statement.split_whitespace();
        match words.next() {
            None => {}
            Some("v") => {
                mesh.vertices.push(vertex(words, line)?);
                lines.vertices.push(line);
            }
            Some("f") => {
                let face: Vec<u32> = words.map(|w| corner(w, mesh.vertices.len(), line)).collect::<Result<_, _>>()?;
                if face.len() < 3 {
                    return Err(MeshError::at(line, format!("a face of {} corners: need at least 3", face.len())));
                }
                mesh.faces.push(face);
                lines.faces.push(line);
            }
            Some(word) if IGNORED.contains(&word) => {}
            Some(word) => return Err(MeshError::at(line, format!("unknown OBJ statement {word:.40?}"))),
        }
    }
    // A face may name a vertex that comes later in the file, so this waits for the end.
    for (face, line) in mesh.faces.iter().zip(&lines.faces) {
        if let Some(i) = face.iter().find(|&&i| i as usize >= mesh.vertices.len()) {
            let n = mesh.vertices.len();
            return Err(MeshError::at(*line, format!("the face names vertex {}, the file has {n}", u64::from(*i) + 1)));
        }
    }
    if mesh.faces.is_empty() {
        return Err(MeshError::whole("no faces: is it an OBJ mesh?"));
    }
    Ok((mesh, lines))
}

/// Statements with the number of their first line: comments cut off, lines that end in `\` joined.
fn statements(text: &str) -> impl Iterator<Item = (u64, String)> + '_ {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().zip(1u64..);
    std::iter::from_fn(move || {
        let (first, number) = lines.next()?;
        let mut statement = first.split('#').next().unwrap_or_default().trim_end().to_owned();
        while statement.ends_with('\\') {
            statement.pop();
            statement.push(' ');
            let Some((next, _)) = lines.next() else { break };
            statement.push_str(next.split('#').next().unwrap_or_default().trim_end());
        }
        Some((number, statement))
    })
}

fn vertex<'a>(words: impl Iterator<Item = &'a str>, line: u64) -> Result<DVec3, MeshError> {
    let numbers: Vec<f64> = words.map(|w| number(w, line)).collect::<Result<_, _>>()?;
    match numbers[..] {
        // A weight after the coordinates, or a colour.
        [x, y, z] | [x, y, z, _] | [x, y, z, _, _, _] | [x, y, z, _, _, _, _] => Ok(DVec3::new(x, y, z)),
        _ => Err(MeshError::at(line, format!("a vertex of {} numbers: need x y z", numbers.len()))),
    }
}

fn number(word: &str, line: u64) -> Result<f64, MeshError> {
    match word.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err(MeshError::at(line, format!("{word:.40?} is not a finite number"))),
        Err(_) => Err(MeshError::at(line, format!("{word:.40?} is not a number"))),
    }
}

/// The vertex index of `i`, `i/t`, `i//n` or `i/t/n`, from 0; `so_far` vertices stand above this line.
fn corner(word: &str, so_far: usize, line: u64) -> Result<u32, MeshError> {
    let index = word.split('/').next().unwrap_or_default();
    let bad = |why: &str| MeshError::at(line, format!("face corner {word:.40?}: {why}"));
    let i: i64 = index.parse().map_err(|_| bad("not an index"))?;
    let from_zero = match i {
        0 => return Err(bad("indices count from 1")),
        1.. => i - 1,
        _ => so_far as i64 + i,
    };
    u32::try_from(from_zero).map_err(|_| bad("no such vertex"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_polygons_negative_indices_and_continued_lines() {
        let text = "\u{feff}# a comment\r\nv 0 0 0\r\nv 1 0 0 1.0 # weight\nv 1 1 0 .5 .5 .5\nv 0 1 \\\n 0\nvn 0 0 1\no plate\nf 1/1/1 2//1 3 -1\n";
        let mesh = parse_obj(text).unwrap();
        assert_eq!(mesh.vertices.len(), 4);
        assert_eq!(mesh.vertices[3], DVec3::Y);
        assert_eq!(mesh.faces, vec![vec![0, 1, 2, 3]]);
    }

    #[test]
    fn a_face_may_name_a_later_vertex() {
        assert_eq!(parse_obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unwrap().faces.len(), 1);
    }

    #[test]
    fn errors_name_their_line() {
        let line_of = |text: &str| parse_obj(text).unwrap_err().line;
        assert_eq!(line_of("v 0 0 0\nv 1 zero 0\n"), Some(2));
        assert_eq!(line_of("v 0 0 nan\n"), Some(1));
        assert_eq!(line_of("v 0 0 inf\n"), Some(1));
        assert_eq!(line_of("v 0 0\n"), Some(1));
        assert_eq!(line_of("v 0 0 0\nf 1 1\n"), Some(2));
        assert_eq!(line_of("v 0 0 0\nf 1 2 3\n"), Some(2));
        assert_eq!(line_of("v 0 0 0\nf 0 1 1\n"), Some(2));
        assert_eq!(line_of("v 0 0 0\nf -2 1 1\n"), Some(2));
        assert_eq!(line_of("v 0 0 0\nf 1 1 99999999999\n"), Some(2));
        assert_eq!(line_of("hello\n"), Some(1));
        assert_eq!(line_of(""), None);
    }
}
