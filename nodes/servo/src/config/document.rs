use super::{Config, NodeSwitch, ParamSpec, node_switches, schema};
use std::fmt::Write;

/// The parameter file with every default and its meaning: `config/haptic_servo.param.yaml`.
#[must_use]
pub fn yaml_template() -> String {
    let head = "# Parameters of haptic_servo, with their defaults.\n# Generated from the schema in nodes/servo/src/config/schema.rs.\n";
    let mut lines: Vec<Line> = schema().iter().map(line).collect();
    for switch in node_switches() {
        let NodeSwitch { name, default, meaning } = *switch;
        // Beside the others of its level, which must not be opened twice.
        let level = name.rsplit_once('.').map_or("", |(level, _)| level);
        let beside = lines.iter().rposition(|(other, ..)| other.starts_with(level)).map_or(lines.len(), |i| i + 1);
        let comment = format!("{meaning} [true, false; at start]");
        lines.insert(if level.is_empty() { 0 } else { beside }, (name, Some(comment), default.to_string()));
    }
    parameter_file(head, lines)
}

/// A ROS 2 parameter file of all parameters of the configuration.
pub(super) fn yaml(config: &Config) -> String {
    parameter_file("", schema().iter().map(|spec| (spec.name, None, (spec.get)(config).to_string())))
}

fn line(spec: &ParamSpec) -> Line {
    let unit = if spec.unit.is_empty() { String::new() } else { format!(" {}", spec.unit) };
    let change = if spec.live { "live" } else { "at start" };
    let comment = format!("{} [{}{unit}; {change}]", spec.meaning, spec.range_text());
    (spec.name, Some(comment), spec.default_value().to_string())
}

/// Name, comment and value.
type Line = (&'static str, Option<String>, String);

/// A ROS 2 parameter file for any node: dotted names become levels, and a level is opened once if its names follow each
/// other. Each parameter is its name, a comment for the line above, and its value as YAML.
pub fn parameter_file<'n>(
    head: &str,
    parameters: impl IntoIterator<Item = (&'n str, Option<String>, String)>,
) -> String {
    let mut text = format!("{head}/**:\n  ros__parameters:\n");
    let mut open: Vec<&str> = Vec::new();
    for (name, comment, value) in parameters {
        let mut path: Vec<&str> = name.split('.').collect();
        let leaf = path.pop().unwrap_or_default();
        let shared = open.iter().zip(&path).take_while(|(a, b)| a == b).count();
        for (level, group) in path.iter().enumerate().skip(shared) {
            let _ = writeln!(text, "{}{group}:", "  ".repeat(level + 2));
        }
        open = path;
        let indent = "  ".repeat(open.len() + 2);
        if let Some(comment) = comment {
            let _ = writeln!(text, "{indent}# {comment}");
        }
        let _ = writeln!(text, "{indent}{leaf}: {value}");
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
    for NodeSwitch { name, default, meaning } in node_switches() {
        let _ = writeln!(text, "| `{name}` | bool |  | true, false | `{default}` | restart | {meaning} |");
    }
    text
}
