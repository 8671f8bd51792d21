use super::Config;
use serde::{Deserialize, Serialize};

/// The value of a parameter, in the types that ROS parameters have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// Yes or no.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A real number.
    Float(f64),
    /// Text.
    Text(String),
}

impl Value {
    /// Name of the type, as `ros2 param` has it.
    #[must_use]
    pub const fn type_name(&self) -> &'static str {
        match self {
            Self::Bool(_) => "bool",
            Self::Int(_) => "integer",
            Self::Float(_) => "double",
            Self::Text(_) => "string",
        }
    }
}

impl std::fmt::Display for Value {
    /// As YAML has it; reads back to the same value.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Bool(b) => write!(f, "{b}"),
            Self::Int(i) => write!(f, "{i}"),
            // `{:?}` keeps the point that makes it a double: ROS refuses 1 where it declared 1.0.
            Self::Float(x) => write!(f, "{x:?}"),
            Self::Text(t) => write!(f, "\"{}\"", t.replace('\\', "\\\\").replace('"', "\\\"")),
        }
    }
}

/// Type and range of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Yes or no.
    Bool,
    /// A whole number, ends included.
    Int {
        /// Least value.
        min: i64,
        /// Greatest value.
        max: i64,
    },
    /// A real number, ends included; NaN is never in range.
    Float {
        /// Least value.
        min: f64,
        /// Greatest value.
        max: f64,
    },
    /// Any text.
    Text,
    /// One of these texts.
    Choice(&'static [&'static str]),
}

/// One parameter: everything that is said about it anywhere comes from here.
#[derive(Clone, Copy)]
pub struct ParamSpec {
    /// Name, dots between the levels of the tree.
    pub name: &'static str,
    /// Type and range.
    pub range: Range,
    /// Unit; empty for none.
    pub unit: &'static str,
    /// Whether a change takes effect while it runs; otherwise at the next start.
    pub live: bool,
    /// What it means, one line.
    pub meaning: &'static str,
    pub(super) get: fn(&Config) -> Value,
    /// Takes a value of the right type and range.
    pub(super) set: fn(&mut Config, &Value),
}

impl std::fmt::Debug for ParamSpec {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ParamSpec").field("name", &self.name).field("range", &self.range).finish_non_exhaustive()
    }
}

/// Why a parameter is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParamError {
    /// There is no such parameter.
    #[error("unknown parameter `{name}`{}", hint(suggestion))]
    Unknown {
        /// What was given.
        name: String,
        /// The parameter with the nearest name, if one is near.
        suggestion: Option<&'static str>,
    },
    /// The value is of another type.
    #[error("parameter `{name}` is of type {got}: need {want}")]
    Type {
        /// The parameter.
        name: &'static str,
        /// The type of the value.
        got: &'static str,
        /// The type of the parameter.
        want: &'static str,
    },
    /// The value is out of range, or NaN.
    #[error("parameter `{name}` = {value}: need {allowed}")]
    Range {
        /// The parameter.
        name: &'static str,
        /// What was given.
        value: String,
        /// What is allowed, with the unit.
        allowed: String,
    },
    /// The file is not a parameter file.
    #[error("{0}")]
    Syntax(String),
}

fn hint(suggestion: &Option<&'static str>) -> String {
    suggestion.map_or(String::new(), |s| format!(": is it `{s}`?"))
}

impl ParamSpec {
    /// The value when nobody says otherwise.
    #[must_use]
    pub fn default_value(&self) -> Value {
        (self.get)(&Config::default())
    }

    /// Name of the type, as `ros2 param` has it.
    #[must_use]
    pub const fn type_name(&self) -> &'static str {
        match self.range {
            Range::Bool => "bool",
            Range::Int { .. } => "integer",
            Range::Float { .. } => "double",
            Range::Text | Range::Choice(_) => "string",
        }
    }

    /// The range in words, without the unit.
    #[must_use]
    pub fn range_text(&self) -> String {
        match self.range {
            Range::Bool => "true, false".into(),
            Range::Int { min, max } => format!("{min} to {max}"),
            Range::Float { min, max } => format!("{min} to {max}"),
            Range::Text => "any".into(),
            Range::Choice(choices) => choices.join(", "),
        }
    }

    /// The value in the parameter's own type, if it is allowed. A whole number is taken where a real one is wanted:
    /// people write `damping: 1`.
    ///
    /// # Errors
    /// Wrong type; out of range; NaN.
    pub fn check(&self, value: &Value) -> Result<Value, ParamError> {
        let value = match (self.range, value) {
            (Range::Float { .. }, Value::Int(i)) => Value::Float(*i as f64),
            _ => value.clone(),
        };
        let fits = match (self.range, &value) {
            (Range::Bool, Value::Bool(_)) | (Range::Text, Value::Text(_)) => true,
            (Range::Int { min, max }, Value::Int(i)) => (min..=max).contains(i),
            // Written so that NaN fails.
            (Range::Float { min, max }, Value::Float(x)) => *x >= min && *x <= max,
            (Range::Choice(choices), Value::Text(t)) => choices.contains(&t.as_str()),
            _ => {
                return Err(ParamError::Type { name: self.name, got: value.type_name(), want: self.type_name() });
            }
        };
        if fits {
            return Ok(value);
        }
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let allowed = match self.range {
            Range::Choice(_) => format!("one of {}", self.range_text()),
            _ => format!("{}{unit}", self.range_text()),
        };
        Err(ParamError::Range { name: self.name, value: value.to_string(), allowed })
    }
}
