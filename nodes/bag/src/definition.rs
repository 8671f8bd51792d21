use crate::BagError;

/// A field of a message, as its .msg file has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Element type: a primitive such as `float64`, or `package/msg/Type`.
    pub element: String,
    /// Most characters of a bounded string, 0 if unbounded or no string.
    pub string_capacity: u64,
    /// How many elements.
    pub count: Count,
}

/// How many elements a field holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// One.
    One,
    /// Exactly so many.
    Array(u64),
    /// At most so many.
    Bounded(u64),
    /// Any number.
    Sequence,
}

/// The primitives of ROS 2 interfaces with their number in type descriptions (rosidl `FieldType.msg`).
/// `char` of a .msg file is an unsigned byte; `wstring` and bounded strings are treated by the parser.
pub(crate) const PRIMITIVES: &[(&str, u64)] = &[
    ("int8", 2),
    ("uint8", 3),
    ("int16", 4),
    ("uint16", 5),
    ("int32", 6),
    ("uint32", 7),
    ("int64", 8),
    ("uint64", 9),
    ("float32", 10),
    ("float64", 11),
    ("char", 3),
    ("bool", 15),
    ("byte", 16),
    ("string", 17),
    ("wstring", 18),
];

/// The fields of `text`, the .msg file of `type_name` (`package/msg/Type`). Constants, defaults and comments are left out.
///
/// # Errors
/// If a line is no field, constant or comment: which line.
pub fn parse_fields(type_name: &str, text: &str) -> Result<Vec<Field>, BagError> {
    let package = type_name.split('/').next().unwrap_or_default();
    let mut fields = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() || is_constant(line) {
            continue;
        }
        let mut words = line.split_whitespace();
        let (Some(kind), Some(name)) = (words.next(), words.next()) else {
            return Err(BagError::message(type_name, format!("line {}: `{line}` is no field", i + 1)));
        };
        let field = parse_type(package, kind)
            .ok_or_else(|| BagError::message(type_name, format!("line {}: `{kind}` is no type", i + 1)))?;
        fields.push(Field { name: name.to_owned(), ..field });
    }
    Ok(fields)
}

/// `uint8 NAME=3`, but not `string<=3 name` or `Type[<=3] name`.
fn is_constant(line: &str) -> bool {
    line.match_indices('=').any(|(i, _)| !line[..i].ends_with('<'))
        && line.split_whitespace().nth(1).is_some_and(|name| name.starts_with(|c: char| c.is_ascii_uppercase()))
}

fn parse_type(package: &str, kind: &str) -> Option<Field> {
    let (element, count) = match kind.strip_suffix(']') {
        None => (kind, Count::One),
        Some(head) => {
            let (element, inside) = head.rsplit_once('[')?;
            let count = match inside.strip_prefix("<=") {
                _ if inside.is_empty() => Count::Sequence,
                Some(n) => Count::Bounded(n.parse().ok()?),
                None => Count::Array(inside.parse().ok()?),
            };
            (element, count)
        }
    };
    let (element, string_capacity) = match element.split_once("<=") {
        Some((s @ ("string" | "wstring"), n)) => (s, n.parse().ok()?),
        Some(_) => return None,
        None => (element, 0),
    };
    let element =
        if PRIMITIVES.iter().any(|(p, _)| *p == element) { element.to_owned() } else { full_name(package, element)? };
    Some(Field { name: String::new(), element, string_capacity, count })
}

/// `Type`, `package/Type` or `package/msg/Type` as `package/msg/Type`.
fn full_name(package: &str, name: &str) -> Option<String> {
    let is_type = |t: &str| t.starts_with(|c: char| c.is_ascii_uppercase());
    match *name.split('/').collect::<Vec<_>>() {
        [t] if is_type(t) => Some(format!("{package}/msg/{t}")),
        [p, t] if is_type(t) => Some(format!("{p}/msg/{t}")),
        [p, "msg", t] if is_type(t) => Some(format!("{p}/msg/{t}")),
        _ => None,
    }
}
