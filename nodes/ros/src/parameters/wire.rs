//! Parameters as the messages of rcl_interfaces have them.

use super::Declared;
use r2r::ParameterValue;
use r2r::rcl_interfaces::msg::{
    FloatingPointRange, IntegerRange, ListParametersResult, ParameterDescriptor, ParameterValue as ValueMsg,
};

/// The names below `prefixes`, at most `depth` levels deep; 0 for any.
pub fn list<'a>(names: impl Iterator<Item = &'a String>, prefixes: &[String], depth: u64) -> ListParametersResult {
    let deep = |rest: &str| depth == 0 || (rest.matches('.').count() as u64) < depth;
    let mut result = ListParametersResult::default();
    for name in names {
        let wanted = if prefixes.is_empty() {
            deep(name)
        } else {
            prefixes.iter().any(|p| name == p || name.strip_prefix(&format!("{p}.")).is_some_and(deep))
        };
        if wanted {
            result.names.push(name.clone());
            if let Some((prefix, _)) = name.rsplit_once('.')
                && !result.prefixes.iter().any(|p| p == prefix)
            {
                result.prefixes.push(prefix.to_owned());
            }
        }
    }
    result
}

/// What tools are told of a parameter.
pub fn descriptor(name: &str, declared: Option<&Declared>) -> ParameterDescriptor {
    let Some(d) = declared else {
        return ParameterDescriptor { name: name.to_owned(), ..Default::default() };
    };
    let mut out = ParameterDescriptor {
        name: name.to_owned(),
        type_: value_message(Some(&d.default)).type_,
        description: d.description.clone(),
        read_only: !d.live,
        additional_constraints: if d.choices.is_empty() {
            String::new()
        } else {
            format!("one of {}", d.choices.join(", "))
        },
        ..Default::default()
    };
    if let Some((from, to)) = d.range {
        match d.default {
            ParameterValue::Integer(_) => {
                out.integer_range = vec![IntegerRange { from_value: from as i64, to_value: to as i64, step: 0 }];
            }
            _ => out.floating_point_range = vec![FloatingPointRange { from_value: from, to_value: to, step: 0.0 }],
        }
    }
    out
}

/// A value, or its absence.
pub fn value_message(value: Option<&ParameterValue>) -> ValueMsg {
    use ParameterValue as V;
    let mut m = ValueMsg::default();
    match value.cloned().unwrap_or(V::NotSet) {
        V::NotSet => {}
        V::Bool(b) => (m.type_, m.bool_value) = (1, b),
        V::Integer(i) => (m.type_, m.integer_value) = (2, i),
        V::Double(x) => (m.type_, m.double_value) = (3, x),
        V::String(s) => (m.type_, m.string_value) = (4, s),
        V::ByteArray(v) => (m.type_, m.byte_array_value) = (5, v),
        V::BoolArray(v) => (m.type_, m.bool_array_value) = (6, v),
        V::IntegerArray(v) => (m.type_, m.integer_array_value) = (7, v),
        V::DoubleArray(v) => (m.type_, m.double_array_value) = (8, v),
        V::StringArray(v) => (m.type_, m.string_array_value) = (9, v),
    }
    m
}

/// The value that a client sent.
pub fn from_message(m: &ValueMsg) -> ParameterValue {
    use ParameterValue as V;
    match m.type_ {
        1 => V::Bool(m.bool_value),
        2 => V::Integer(m.integer_value),
        3 => V::Double(m.double_value),
        4 => V::String(m.string_value.clone()),
        5 => V::ByteArray(m.byte_array_value.clone()),
        6 => V::BoolArray(m.bool_array_value.clone()),
        7 => V::IntegerArray(m.integer_array_value.clone()),
        8 => V::DoubleArray(m.double_array_value.clone()),
        9 => V::StringArray(m.string_array_value.clone()),
        _ => V::NotSet,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ParameterValue as V;

    #[test]
    fn values_travel_through_messages_unchanged() {
        for v in [
            V::Bool(true),
            V::Integer(-3),
            V::Double(0.1),
            V::String("x".into()),
            V::StringArray(vec!["a".into()]),
            V::DoubleArray(vec![1.5]),
        ] {
            assert_eq!(from_message(&value_message(Some(&v))), v);
        }
    }

    #[test]
    fn lists_by_prefix_and_depth() {
        let names = ["gains.damping", "gains.stiffness", "scene"].map(str::to_owned);
        assert_eq!(list(names.iter(), &[], 1).names, ["scene"]);
        let gains = list(names.iter(), &["gains".to_owned()], 0);
        assert_eq!((gains.names.len(), gains.prefixes), (2, vec!["gains".to_owned()]));
    }
}
