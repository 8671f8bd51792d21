use crate::BagError;
use crate::definition::parse_fields;
use crate::type_hash::rihs01;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What a bag says about a message type: its name, its definition with all that it refers to, and its hash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TypeDescription {
    /// `package/msg/Type`.
    pub name: String,
    /// The .msg text, then each type that it refers to after a line of 80 `=` and `MSG: package/Type` (`ros2msg`).
    pub schema: String,
    /// `RIHS01_` and the SHA-256 of the type description.
    pub hash: String,
}

macro_rules! texts {
    ($root:literal, $package:literal: $($type:literal)*) => {
        &[$((concat!($package, "/msg/", $type), include_str!(concat!($root, $type, ".msg")))),*]
    };
}

const BUILT_IN: &[&[(&str, &str)]] = &[
    texts!("../../../msgs/msg/", "cspace_haptics_msgs":
        "BasicContact" "CFace" "ContactPoint" "ContactState" "DeviceSample" "Gains" "LocalCSpace" "PrincipalContact"
        "SceneDescription" "SceneFile" "ServoConfiguration" "ServoHealth" "TickBatch" "TickRecord"),
    texts!("../definitions/builtin_interfaces/", "builtin_interfaces": "Duration" "Time"),
    texts!("../definitions/std_msgs/", "std_msgs": "ColorRGBA" "Header" "String"),
    texts!("../definitions/geometry_msgs/", "geometry_msgs":
        "Point" "Pose" "PoseStamped" "Quaternion" "Transform" "TransformStamped" "Twist" "TwistStamped" "Vector3" "Wrench"
        "WrenchStamped"),
    texts!("../definitions/sensor_msgs/", "sensor_msgs": "CompressedImage" "Joy"),
    texts!("../definitions/diagnostic_msgs/", "diagnostic_msgs": "DiagnosticArray" "DiagnosticStatus" "KeyValue"),
    texts!("../definitions/visualization_msgs/", "visualization_msgs": "Marker" "MarkerArray" "MeshFile" "UVCoordinate"),
    texts!("../definitions/tf2_msgs/", "tf2_msgs": "TFMessage"),
    texts!("../definitions/rosgraph_msgs/", "rosgraph_msgs": "Clock"),
];

/// Message definitions: those of this project and the standard ones that it records are built in, any other is looked
/// up in the sourced ROS (`share/<package>/msg/<Type>.msg` below the prefixes).
#[derive(Clone, Debug, Default)]
pub struct Catalog {
    prefixes: Vec<PathBuf>,
}

impl Catalog {
    /// The built-in definitions alone.
    #[must_use]
    pub fn built_in() -> Self {
        Self::default()
    }

    /// The built-in definitions, then those below the given ament prefixes (the entries of `AMENT_PREFIX_PATH`).
    #[must_use]
    pub fn with_prefixes(prefixes: impl IntoIterator<Item = PathBuf>) -> Self {
        Self { prefixes: prefixes.into_iter().collect() }
    }

    /// Name, schema and hash of a type.
    ///
    /// # Errors
    /// If the type or one that it refers to is not known, or its definition is not understood.
    pub fn describe(&self, type_name: &str) -> Result<TypeDescription, BagError> {
        let mut found = BTreeMap::new();
        let mut order = Vec::new();
        self.collect(type_name, type_name, &mut found, &mut order)?;
        let mut schema = found[type_name].0.clone();
        for name in &order[1..] {
            if !schema.ends_with('\n') {
                schema.push('\n');
            }
            schema.push_str(&"=".repeat(80));
            schema.push_str(&format!("\nMSG: {}\n{}", name.replacen("/msg/", "/", 1), found[name].0));
        }
        let fields = found.into_iter().map(|(name, (_, fields))| (name, fields)).collect();
        let hash = rihs01(type_name, &fields);
        Ok(TypeDescription { name: type_name.to_owned(), schema, hash })
    }

    fn collect(
        &self,
        type_name: &str,
        asked_for: &str,
        found: &mut BTreeMap<String, (String, Vec<crate::definition::Field>)>,
        order: &mut Vec<String>,
    ) -> Result<(), BagError> {
        if found.contains_key(type_name) {
            return Ok(());
        }
        let text = self.text(type_name).ok_or_else(|| {
            let what = if type_name == asked_for { "this type is".to_owned() } else { format!("{type_name} in it is") };
            BagError::message(asked_for, format!("{what} not known; source the ROS workspace that defines it"))
        })?;
        let fields = parse_fields(type_name, &text)?;
        let nested: Vec<String> =
            fields.iter().filter(|f| f.element.contains('/')).map(|f| f.element.clone()).collect();
        found.insert(type_name.to_owned(), (text, fields));
        order.push(type_name.to_owned());
        nested.iter().try_for_each(|n| self.collect(n, asked_for, found, order))
    }

    fn text(&self, type_name: &str) -> Option<String> {
        let built_in = BUILT_IN.iter().copied().flatten().find(|(name, _)| *name == type_name);
        if let Some((_, text)) = built_in {
            return Some((*text).to_owned());
        }
        let (package, rest) = type_name.split_once("/msg/")?;
        let is_name = |s: &str| !s.is_empty() && s.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !is_name(package) || !is_name(rest) {
            return None;
        }
        self.prefixes.iter().find_map(|p| {
            std::fs::read_to_string(p.join("share").join(package).join("msg").join(format!("{rest}.msg"))).ok()
        })
    }
}
