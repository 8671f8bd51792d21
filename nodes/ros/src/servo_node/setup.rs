use crate::parameters::Declared;
use crate::{Failure, Outcome};
use r2r::ParameterValue as V;
use servo::config::{Config, ParamSpec, Range, Value, node_switches, schema};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The servo's parameters: the schema of its configuration, and what concerns the node alone.
#[must_use]
pub fn declared() -> Vec<Declared> {
    let mut all: Vec<Declared> = schema().iter().map(from_spec).collect();
    all.extend(node_switches().iter().map(|s| Declared::fixed(s.name, V::Bool(s.default), s.meaning)));
    all
}

fn from_spec(spec: &ParamSpec) -> Declared {
    let unit = if spec.unit.is_empty() { String::new() } else { format!(" [{}]", spec.unit) };
    let mut d = Declared::fixed(spec.name, to_ros(&spec.default_value()), &format!("{}{unit}", spec.meaning));
    d.live = spec.live;
    match spec.range {
        Range::Bool | Range::Text => d,
        Range::Int { min, max } => d.within(min as f64, max as f64),
        Range::Float { min, max } => d.within(min, max),
        Range::Choice(choices) => d.one_of(choices),
    }
}

/// Sets what the node's parameters say; the configuration's own checks have the last word.
///
/// # Errors
/// The first value that is refused, and why.
pub fn apply(config: &mut Config, values: &BTreeMap<String, V>) -> Result<(), String> {
    for spec in schema() {
        if let Some(value) = values.get(spec.name).and_then(from_ros) {
            config.set(spec.name, &value).map_err(|e| e.to_string())?;
        }
    }
    Ok(())
}

fn to_ros(value: &Value) -> V {
    match value {
        Value::Bool(b) => V::Bool(*b),
        Value::Int(i) => V::Integer(*i),
        Value::Float(x) => V::Double(*x),
        Value::Text(t) => V::String(t.clone()),
    }
}

fn from_ros(value: &V) -> Option<Value> {
    match value {
        V::Bool(b) => Some(Value::Bool(*b)),
        V::Integer(i) => Some(Value::Int(*i)),
        V::Double(x) => Some(Value::Float(*x)),
        V::String(t) => Some(Value::Text(t.clone())),
        _ => None,
    }
}

/// The scene's file: `scene` itself if it is one, else the installed scene of that name: below the ament prefixes, or
/// beside the sources that this program was built from.
///
/// # Errors
/// Neither exists: which names there are.
pub fn scene_file(scene: &str) -> Outcome<PathBuf> {
    let given = Path::new(scene);
    if given.is_file() {
        return Ok(given.to_path_buf());
    }
    let folders = scene_folders();
    let is_name = !scene.is_empty() && given.components().count() == 1;
    if is_name && let Some(found) = folders.iter().map(|f| f.join(scene).join("scene.yaml")).find(|f| f.is_file()) {
        return Ok(found);
    }
    let mut known: Vec<String> = folders
        .iter()
        .filter_map(|f| std::fs::read_dir(f).ok())
        .flat_map(|entries| entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()))
        .collect();
    known.sort();
    known.dedup();
    Err(Failure::new(format!(
        "{scene}: no such scene; parameter `scene` is a scene.yaml or one of: {}",
        if known.is_empty() { "(none installed)".to_owned() } else { known.join(", ") }
    )))
}

fn scene_folders() -> Vec<PathBuf> {
    let prefixes = std::env::var_os("AMENT_PREFIX_PATH").unwrap_or_default();
    let installed = std::env::split_paths(&prefixes).map(|p| p.join("share/cspace_haptics/config/scenes"));
    let beside = std::env::current_exe()
        .ok()
        .into_iter()
        .flat_map(|exe| exe.ancestors().map(|a| a.join("config/scenes")).collect::<Vec<_>>());
    installed.chain(beside).filter(|f| f.is_dir()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_of_the_schema_reaches_the_configuration() {
        let all = declared();
        for spec in schema() {
            let d = all.iter().find(|d| d.name == spec.name).unwrap();
            assert_eq!(d.live, spec.live, "{}", spec.name);
            assert_eq!(d.accept(&d.default), Ok(d.default.clone()), "{}", spec.name);
        }
        let mut config = Config::default();
        apply(&mut config, &[("gains.stiffness".to_owned(), V::Double(321.0))].into()).unwrap();
        assert_eq!(config.gains.stiffness, 321.0);
        assert!(apply(&mut config, &[("gains.stiffness".to_owned(), V::Double(-1.0))].into()).is_err());
    }

    #[test]
    fn an_unknown_scene_is_one_line_that_names_the_known_ones() {
        let e = scene_file("no_such_scene").unwrap_err().to_string();
        assert!(e.contains("no_such_scene") && !e.contains('\n'), "{e}");
        assert!(scene_file("../x").is_err() && scene_file("").is_err());
    }
}
