use crate::definition::{Count, Field, PRIMITIVES};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The type hash of REP 2016: SHA-256 over the JSON of the type description (names, types and sizes of the fields, and
/// those of every type referred to, sorted by name), without constants, defaults and comments.
pub(crate) fn rihs01(type_name: &str, types: &BTreeMap<String, Vec<Field>>) -> String {
    let mut json = format!(
        "{{\"type_description\": {}, \"referenced_type_descriptions\": [",
        describe(type_name, &types[type_name])
    );
    let referenced: Vec<String> = types.iter().filter(|(n, _)| *n != type_name).map(|(n, f)| describe(n, f)).collect();
    json.push_str(&referenced.join(", "));
    json.push_str("]}");
    let mut hash = String::from("RIHS01_");
    for byte in Sha256::digest(json.as_bytes()) {
        let _ = write!(hash, "{byte:02x}");
    }
    hash
}

fn describe(type_name: &str, fields: &[Field]) -> String {
    // rosidl gives an empty message one byte, since C has no empty structures.
    let filler = [Field {
        name: "structure_needs_at_least_one_member".to_owned(),
        element: "uint8".to_owned(),
        string_capacity: 0,
        count: Count::One,
    }];
    let fields = if fields.is_empty() { &filler[..] } else { fields };
    let fields: Vec<String> = fields.iter().map(describe_field).collect();
    format!("{{\"type_name\": \"{type_name}\", \"fields\": [{}]}}", fields.join(", "))
}

fn describe_field(field: &Field) -> String {
    let primitive = PRIMITIVES.iter().find(|(name, _)| *name == field.element).map(|(_, id)| *id);
    let (element_id, nested) = match primitive {
        Some(17 | 18) if field.string_capacity > 0 => (if field.element == "string" { 21 } else { 22 }, ""),
        Some(id) => (id, ""),
        None => (1, field.element.as_str()),
    };
    let (offset, capacity) = match field.count {
        Count::One => (0, 0),
        Count::Array(n) => (48, n),
        Count::Bounded(n) => (96, n),
        Count::Sequence => (144, 0),
    };
    format!(
        "{{\"name\": \"{}\", \"type\": {{\"type_id\": {}, \"capacity\": {capacity}, \"string_capacity\": {}, \"nested_type_name\": \"{nested}\"}}}}",
        field.name,
        element_id + offset,
        field.string_capacity
    )
}

#[cfg(test)]
mod tests {
    use crate::Catalog;

    #[test]
    fn standard_types_have_the_hashes_that_ros_2_jazzy_ships() {
        for (name, hash) in [
            ("builtin_interfaces/msg/Time", "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197"),
            ("std_msgs/msg/String", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"),
            ("geometry_msgs/msg/PoseStamped", "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"),
            ("geometry_msgs/msg/WrenchStamped", "8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77"),
            ("sensor_msgs/msg/Joy", "0d356c79cad3401e35ffeb75a96a96e08be3ef896b8b83841d73e890989372c5"),
            ("diagnostic_msgs/msg/DiagnosticArray", "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"),
            ("visualization_msgs/msg/MarkerArray", "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"),
            ("tf2_msgs/msg/TFMessage", "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"),
        ] {
            assert_eq!(Catalog::built_in().describe(name).unwrap().hash, format!("RIHS01_{hash}"), "{name}");
        }
    }
}
