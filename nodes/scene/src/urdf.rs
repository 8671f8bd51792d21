use crate::{Mesh, MeshError};
use spatial::{DVec3, Pose};
use std::collections::HashMap;

/// One collision geometry of a URDF, in the frame of its root link.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfGeometry {
    /// Where it is.
    pub root_from_geometry: Pose,
    /// What it is.
    pub shape: UrdfShape,
}

/// A shape that has flat faces.
#[derive(Clone, Debug, PartialEq)]
pub enum UrdfShape {
    /// A mesh file, as the URDF names it, and the factors on its coordinates.
    Mesh {
        /// `filename` of the URDF.
        file: String,
        /// `scale` of the URDF.
        scale: DVec3,
    },
    /// A box about the origin.
    Box(Mesh),
}

/// The collision geometries of a URDF with all joints at zero. Round shapes are refused: they have no faces.
pub fn parse_urdf(text: &str) -> Result<Vec<UrdfGeometry>, MeshError> {
    let document = roxmltree::Document::parse(text)
        .map_err(|e| MeshError { line: Some(u64::from(e.pos().row)), reason: format!("not XML: {e}") })?;
    let at = |node: roxmltree::Node<'_, '_>, reason: String| {
        MeshError::at(u64::from(document.text_pos_at(node.range().start).row), reason)
    };
    let robot = document.root_element();
    if robot.tag_name().name() != "robot" {
        return Err(at(robot, format!("the root element is <{}>: need <robot>", robot.tag_name().name())));
    }
    let joints = joints(robot, &at)?;
    let mut geometries = Vec::new();
    for link in children(robot, "link") {
        let root_from_link = chain(link.attribute("name").unwrap_or_default(), &joints)
            .ok_or_else(|| at(link, "the joints of this link run in a circle".into()))?;
        for collision in children(link, "collision") {
            let shape_node = children(collision, "geometry")
                .flat_map(|g| g.children().filter(roxmltree::Node::is_element))
                .next()
                .ok_or_else(|| at(collision, "<collision> without a shape in <geometry>".into()))?;
            let shape = match shape_node.tag_name().name() {
                "box" => UrdfShape::Box(cuboid(vector(shape_node, "size", DVec3::NAN, &at)?)),
                "mesh" => UrdfShape::Mesh {
                    file: shape_node
                        .attribute("filename")
                        .ok_or_else(|| at(shape_node, "<mesh> without a filename".into()))?
                        .to_owned(),
                    scale: vector(shape_node, "scale", DVec3::ONE, &at)?,
                },
                other => return Err(at(shape_node, format!("<{other}> has no flat faces: use a mesh or a box"))),
            };
            let root_from_geometry = root_from_link * origin(collision, &at)?;
            geometries.push(UrdfGeometry { root_from_geometry, shape });
        }
    }
    if geometries.is_empty() { Err(MeshError::whole("no <collision> geometry in the URDF")) } else { Ok(geometries) }
}

/// Parent link and pose in it, by child link.
type Joints<'a> = HashMap<&'a str, (&'a str, Pose)>;

fn joints<'a>(
    robot: roxmltree::Node<'a, '_>,
    at: &impl Fn(roxmltree::Node<'_, '_>, String) -> MeshError,
) -> Result<Joints<'a>, MeshError> {
    let mut joints = HashMap::new();
    for joint in children(robot, "joint") {
        let link = |tag| children(joint, tag).next().and_then(|n| n.attribute("link"));
        let (Some(parent), Some(child)) = (link("parent"), link("child")) else {
            return Err(at(joint, "<joint> needs a parent and a child link".into()));
        };
        joints.insert(child, (parent, origin(joint, at)?));
    }
    Ok(joints)
}

fn chain(link: &str, joints: &Joints<'_>) -> Option<Pose> {
    let (mut link, mut pose) = (link, Pose::IDENTITY);
    for _ in 0..=joints.len() {
        let Some((parent, parent_from_link)) = joints.get(link) else { return Some(pose) };
        pose = *parent_from_link * pose;
        link = parent;
    }
    None
}

fn children<'a, 'i>(node: roxmltree::Node<'a, 'i>, tag: &'static str) -> impl Iterator<Item = roxmltree::Node<'a, 'i>> {
    node.children().filter(move |n| n.has_tag_name(tag))
}

fn origin(
    node: roxmltree::Node<'_, '_>,
    at: &impl Fn(roxmltree::Node<'_, '_>, String) -> MeshError,
) -> Result<Pose, MeshError> {
    let Some(origin) = children(node, "origin").next() else { return Ok(Pose::IDENTITY) };
    Ok(Pose::from_xyz_rpy(vector(origin, "xyz", DVec3::ZERO, at)?, vector(origin, "rpy", DVec3::ZERO, at)?))
}

/// Three finite numbers of an attribute; `default` when it is absent, which NaN forbids.
fn vector(
    node: roxmltree::Node<'_, '_>,
    attribute: &str,
    default: DVec3,
    at: &impl Fn(roxmltree::Node<'_, '_>, String) -> MeshError,
) -> Result<DVec3, MeshError> {
    let v = match node.attribute(attribute) {
        None => default,
        Some(text) => {
            let numbers: Vec<f64> = text.split_whitespace().map_while(|w| w.parse().ok()).collect();
            <[f64; 3]>::try_from(numbers).map_or(DVec3::NAN, DVec3::from)
        }
    };
    if v.is_finite() { Ok(v) } else { Err(at(node, format!("`{attribute}` needs three finite numbers"))) }
}

fn cuboid(size: DVec3) -> Mesh {
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5;
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh { vertices: (0..8).map(|i| corner(i) * size).collect(), faces: faces.map(|f| f.to_vec()).to_vec() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn geometry_stands_in_the_root_links_frame() {
        let text = r#"<robot name="r">
            <link name="base"/>
            <joint name="j" type="fixed"><parent link="base"/><child link="tip"/><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/></joint>
            <link name="tip"><collision><origin xyz="1 0 0"/><geometry><box size="2 2 2"/></geometry></collision>
              <collision><geometry><mesh filename="a.stl" scale="0.001 0.001 0.001"/></geometry></collision></link>
        </robot>"#;
        let geometries = parse_urdf(text).unwrap();
        assert!((geometries[0].root_from_geometry.translation - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-12);
        assert!(matches!(&geometries[0].shape, UrdfShape::Box(b) if (b.volume() - 8.0).abs() < 1e-12));
        assert!(matches!(&geometries[1].shape, UrdfShape::Mesh { file, scale } if file == "a.stl" && scale.x == 0.001));
    }

    #[test]
    fn broken_urdf_names_its_line() {
        let line = |body: &str| parse_urdf(&format!("<robot>\n{body}\n</robot>")).unwrap_err().line;
        let shape = |s: &str| format!("<link name='a'><collision><geometry>\n{s}</geometry></collision></link>");
        assert_eq!(line(&shape("<sphere radius='1'/>")), Some(3));
        assert_eq!(line(&shape("<box size='1 2'/>")), Some(3));
        assert_eq!(line(&shape("<box size='1 2 nan'/>")), Some(3));
        assert_eq!(line(&shape("<box/>")), Some(3));
        assert_eq!(line(""), None);
        assert_eq!(
            line("<joint><parent link='a'/><child link='a'/></joint>\n<link name='a'><collision/></link>"),
            Some(3)
        );
        assert!(parse_urdf("<a>").unwrap_err().line.is_some());
        assert!(parse_urdf("<a/>").is_err());
    }
}
