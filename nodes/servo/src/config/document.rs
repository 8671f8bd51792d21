use super::{Config, schema};
use std::fmt::Write;

/// The parameter file with every default and its meaning: `config/haptic_servo.param.yaml`.
#[must_use]
pub fn yaml_template() -> String {
    yaml(&Config::default(), true)
}

/// A ROS 2 parameter file of all parameters, with or without their meanings as comments.
pub(super) fn yaml(config: &Config, comments: bool) -> String {
    let mut text = String::new();
    if comments {
        text += "# Parameters of haptic_servo, with their defaults.\n# Generated from the schema in nodes/servo/src/config/schema.rs.\n";
    }
    text += "/**:\n  ros__parameters:\n";
    let mut open: Vec<&str> = Vec::new();
    for spec in schema() {
        let mut path: Vec<&str> = spec.name.split('.').collect();
        let leaf = path.pop().unwrap_or_default();
        let shared = open.iter().zip(&path).take_while(|(a, b)| a == b).count();
        for (level, group) in path.iter().enumerate().skip(shared) {
            let _ = writeln!(text, "{}{group}:", "  ".repeat(level + 2));
        }
        open = path;
        let indent = "  ".repeat(open.len() + 2);
        if comments {
            let unit = if spec.unit.is_empty() { String::new() } else { format!(" {}", spec.unit) };
            let change = if spec.live { "live" } else { "at start" };
            let _ = writeln!(text, "{indent}# {} [{}{unit}; {change}]", spec.meaning, spec.range_text());
        }
        let _ = writeln!(text, "{indent}{leaf}: {}", (spec.get)(config));
    }
    text
}

/// The table of parameters for the documentation: `config/PARAMETERS.md`.
#[must_use]
pub fn markdown_table() -> String {
    let mut text = String::from(
        "| parameter | type | unit | range | default | change | meaning |\n|---|---|---|---|---|---|---|\n",
    );
    for spec in schema() {
        let change = if spec.live { "live" } else { "restart" };
        let (name, kind, unit, range) = (spec.name, spec.type_name(), spec.unit, spec.range_text());
        let default = spec.default_value();
        let _ = writeln!(text, "| `{name}` | {kind} | {unit} | {range} | `{default}` | {change} | {} |", spec.meaning);
    }
    text
}
