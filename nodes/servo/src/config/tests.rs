use super::*;
use std::collections::HashSet;

#[test]
fn every_default_is_allowed_and_survives_a_round_trip() {
    let mut names = HashSet::new();
    for spec in schema() {
        assert!(names.insert(spec.name), "{} stands twice", spec.name);
        assert_eq!(spec.check(&spec.default_value()), Ok(spec.default_value()), "{}", spec.name);
        assert!(!spec.meaning.is_empty());
    }
    assert_eq!(Config::from_yaml(&yaml_template()), Ok(Config::default()));
}

#[test]
fn setting_reaches_exactly_the_field_that_getting_reads() {
    for spec in schema() {
        let other = match (spec.range, spec.default_value()) {
            (Range::Bool, Value::Bool(b)) => Value::Bool(!b),
            (Range::Int { min, max }, Value::Int(i)) => Value::Int(if i == max { min } else { max }),
            (Range::Float { min, max }, Value::Float(x)) => Value::Float(if x == max { min } else { max }),
            (Range::Choice(all), Value::Text(t)) => Value::Text((*all.iter().find(|c| **c != t).unwrap()).into()),
            _ => Value::Text("a \"quoted\" \\ text: #1".into()),
        };
        let mut config = Config::default();
        config.set(spec.name, &other).unwrap();
        for s in schema() {
            let expected = if s.name == spec.name { other.clone() } else { s.default_value() };
            assert_eq!(config.get(s.name).unwrap(), expected, "{} after setting {}", s.name, spec.name);
        }
        assert_eq!(Config::from_yaml(&config.to_yaml()), Ok(config), "{}", spec.name);
    }
}

#[test]
fn forbidden_values_are_refused_with_the_reason() {
    let table: &[(&str, Value, &str)] = &[
        ("gains.stiffness", Value::Float(f64::NAN), "1 to 20000 N/m"),
        ("gains.stiffness", Value::Float(f64::INFINITY), "1 to 20000 N/m"),
        ("gains.stiffness", Value::Float(-1.0), "1 to 20000 N/m"),
        ("gains.stiffness", Value::Text("stiff".into()), "need double"),
        ("gains.stiffness", Value::Bool(true), "need double"),
        ("law", Value::Text("magic".into()), "one of paper, pstar, blended, proxy"),
        ("realtime.priority", Value::Int(100), "0 to 99"),
        ("realtime.priority", Value::Float(1.0), "is of type double: need integer"),
        ("realtime.rate", Value::Int(100), "250 to 10000 Hz"),
        ("passivity.enabled", Value::Int(1), "need bool"),
        ("stiffness", Value::Float(1.0), "is it `gains.stiffness`?"),
        ("nonsense", Value::Float(1.0), "unknown parameter `nonsense`"),
    ];
    for (name, value, reason) in table {
        let mut config = Config::default();
        let error = config.set(name, value).unwrap_err().to_string();
        assert!(error.contains(reason), "{name} = {value}: {error}");
        assert_eq!(config, Config::default(), "nothing may change");
    }
}

#[test]
fn a_whole_number_is_taken_for_a_real_one() {
    let mut config = Config::default();
    config.set("gains.stiffness", &Value::Int(500)).unwrap();
    assert_eq!(config.gains.stiffness, 500.0);
}

#[test]
fn forbidden_files_are_refused() {
    for yaml in [
        "- 1",
        "7",
        "/**: [",
        "/**:\n  ros__parameters:\n    gains: {stiffness: .nan}\n",
        "/**:\n  ros__parameters:\n    gains: {stiffness: 1e9}\n",
        "/**:\n  ros__parameters:\n    gains: {stiffnes: 1.0}\n",
        "/**:\n  ros__parameters:\n    gains: 1.0\n",
        "/**:\n  ros__parameters:\n    law: [paper]\n",
        "lam: paper\n",
    ] {
        assert!(Config::from_yaml(yaml).is_err(), "{yaml:?}");
    }
    let not_finite = Config::from_yaml("gains:\n  stiffness: .nan\n").unwrap_err().to_string();
    assert_eq!(not_finite, "parameter `gains.stiffness` = NaN: need 1 to 20000 N/m");
    let twice = Config::from_yaml("law: paper\nlaw: pstar\n").unwrap_err().to_string();
    assert!(twice.contains("duplicate mapping key `law` is not allowed here"), "{twice}");
    let config =
        Config::from_yaml("a:\n  ros__parameters: {law: paper}\nb:\n  ros__parameters: {law: pstar}\n").unwrap();
    assert_eq!(config.gains.law, haptics::LawKind::Pstar, "later ones win");
    assert_eq!(Config::from_yaml("law: blended\n").unwrap().gains.law, haptics::LawKind::Blended);
}

#[test]
fn a_file_for_the_node_serves_offline_too() {
    let text = "/**:\n  ros__parameters:\n    enabled: true\n    device: {trust_stamps: false}\n    law: paper\n";
    assert_eq!(Config::from_yaml(text).unwrap().gains.law, haptics::LawKind::Paper);
    assert!(Config::from_yaml("enabled: 1\n").unwrap_err().to_string().contains("`enabled`"));
    assert_eq!(Config::from_yaml(&yaml_template()), Ok(Config::default()));
    let template = yaml_template();
    for switch in node_switches() {
        let leaf = switch.name.rsplit('.').next().unwrap();
        assert!(template.contains(&format!(" {leaf}: {}\n", switch.default)), "{leaf}");
        assert!(markdown_table().contains(&format!("`{}`", switch.name)), "{}", switch.name);
    }
}

#[test]
fn of_a_file_for_several_nodes_the_servo_takes_its_own() {
    let text = "/**:\n  ros__parameters: {frame_id: base}\n/left/haptic_servo:\n  ros__parameters: {law: paper}\n\
        haptic_recorder:\n  ros__parameters: {topics: [/a, /b], law: 3}\n";
    let config = Config::from_yaml(text).unwrap();
    assert_eq!((config.gains.law, config.frame_id.as_str()), (haptics::LawKind::Paper, "base"));
    let list = Config::from_yaml("gains:\n  stiffness: [1, 2]\n").unwrap_err().to_string();
    assert!(list.contains("`gains.stiffness` is a list"), "{list}");
}

/// Rewrites the files when `UPDATE_GENERATED` is set, otherwise compares.
#[test]
fn the_committed_template_and_table_are_fresh() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    let table = format!(
        "# Parameters of haptic_servo\n\nGenerated from `nodes/servo/src/config/schema.rs`.\n\n{}",
        markdown_table()
    );
    for (name, text) in [("haptic_servo.param.yaml", yaml_template()), ("PARAMETERS.md", table)] {
        let file = folder.join(name);
        if std::env::var_os("UPDATE_GENERATED").is_some() {
            std::fs::write(&file, &text).unwrap();
        }
        let committed = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(committed == text, "config/{name} is stale: run `UPDATE_GENERATED=1 cargo test -p servo fresh`");
    }
}
