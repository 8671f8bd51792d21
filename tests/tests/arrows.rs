//! The crates of the workspace use one another in one direction only, and what is heavy or needs a system library stays
//! in one place.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Who may use whom. `spatial <- cspace <- haptics`; device, realtime and scene beside them; all `<- servo <-` bag and
/// inspect `<-` the program and the ROS nodes. `xtask` works when nothing else does.
const ALLOWED: &[(&str, &[&str])] = &[
    ("spatial", &[]),
    ("realtime", &["spatial"]),
    ("cspace", &["spatial"]),
    ("device", &["spatial"]),
    ("haptics", &["spatial", "cspace"]),
    ("scene", &["spatial", "cspace"]),
    ("servo", &["spatial", "cspace", "haptics", "scene", "device", "realtime"]),
    ("bag", &["spatial", "cspace", "haptics", "scene", "device", "realtime", "servo"]),
    ("inspect", &["spatial", "cspace", "haptics", "scene", "device", "realtime", "servo"]),
    ("cli", &["spatial", "cspace", "haptics", "scene", "device", "realtime", "servo", "bag", "inspect"]),
    ("cspace_haptics", &["spatial", "cspace", "haptics", "scene", "device", "realtime", "servo", "bag", "inspect"]),
    ("xtask", &[]),
    ("system-tests", &["spatial", "cspace", "haptics", "scene", "device", "realtime", "servo", "bag"]),
];

/// Crates from outside that only one of ours may use.
const ALONE: &[(&str, &str)] = &[("r2r", "cspace_haptics"), ("rerun", "inspect"), ("hidapi", "device")];

fn metadata() -> Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1", "--manifest-path"])
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml"))
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("cargo metadata is JSON")
}

/// The names that each crate depends on, whatever for: building, running or testing.
fn dependencies(metadata: &Value) -> BTreeMap<String, BTreeSet<String>> {
    let name = |value: &Value| value["name"].as_str().expect("a name").to_owned();
    let packages = metadata["packages"].as_array().expect("packages");
    packages
        .iter()
        .map(|package| {
            (name(package), package["dependencies"].as_array().expect("dependencies").iter().map(name).collect())
        })
        .collect()
}

/// What stands against the rules, in words.
fn violations(graph: &BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    let mut found = Vec::new();
    for (user, used) in graph {
        let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| name == user) else {
            found.push(format!("{user}: a crate that has no place in the table of arrows"));
            continue;
        };
        for name in used {
            if graph.contains_key(name) && !allowed.contains(&name.as_str()) {
                found.push(format!("{user} must not use {name}"));
            }
            if let Some((_, owner)) = ALONE.iter().find(|(alone, _)| alone == name)
                && owner != user
            {
                found.push(format!("{user} must not use {name}: {owner} alone does"));
            }
        }
    }
    found
}

#[test]
fn arrows_run_one_way() {
    let graph = dependencies(&metadata());
    assert_eq!(violations(&graph), Vec::<String>::new());
    for (name, _) in ALLOWED {
        assert!(graph.contains_key(*name), "{name} is in the table but not in the workspace");
    }
}

#[test]
fn a_wrong_arrow_is_found() {
    let mut graph = dependencies(&metadata());
    let mut add = |user: &str, used: &str| graph.get_mut(user).expect("a crate").insert(used.to_owned());
    add("spatial", "servo");
    add("haptics", "rerun");
    let found = violations(&graph);
    assert_eq!(found, ["haptics must not use rerun: inspect alone does", "spatial must not use servo"]);
}

#[test]
fn what_is_built_by_default_needs_no_ros() {
    let metadata = metadata();
    let by_default: BTreeSet<&str> = metadata["workspace_default_members"]
        .as_array()
        .expect("default members")
        .iter()
        .filter_map(Value::as_str)
        .collect();
    let packages = metadata["packages"].as_array().expect("packages");
    let left_out: Vec<&str> = packages
        .iter()
        .filter(|package| !by_default.contains(package["id"].as_str().expect("an id")))
        .map(|package| package["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(left_out, ["cspace_haptics"], "all but the ROS nodes are built by default");
}
