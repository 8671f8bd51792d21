//! Names of nodes in parameter files that are patterns.
//!
//! The middleware binding knows `/**` and full names only and passes over everything else in silence, also over
//! `/left/*` or `/**/haptic_servo`, which other nodes understand: limits would not be set and nobody would know.

/// The first pattern among the node names of the parameter file `text` that means the node `fqn` and would not be heard.
pub fn unheard_pattern(text: &str, fqn: &str) -> Option<String> {
    node_names(text).into_iter().find(|name| {
        name.contains('*') && !["/**", "**"].contains(&name.as_str()) && {
            let (pattern, node): (Vec<&str>, Vec<&str>) = (tokens(name), tokens(fqn));
            matches(&pattern, &node)
        }
    })
}

/// What stands above each `ros__parameters`, levels joined by slashes. Block style is read, which is how parameter files
/// are written.
fn node_names(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut open: Vec<(usize, String)> = Vec::new();
    for line in text.lines() {
        let trimmed = line.trim_start();
        let Some((key, _)) = trimmed.split_once(':').filter(|_| !trimmed.starts_with('#')) else { continue };
        let indent = line.len() - trimmed.len();
        open.retain(|(level, _)| *level < indent);
        let key = key.trim().trim_matches(['"', '\'']);
        if key == "ros__parameters" {
            names.push(open.iter().map(|(_, k)| k.as_str()).collect::<Vec<_>>().join("/"));
        }
        open.push((indent, key.to_owned()));
    }
    names
}

fn tokens(name: &str) -> Vec<&str> {
    name.split('/').filter(|t| !t.is_empty()).collect()
}

/// `*` is one level of the name, `**` any number of them.
fn matches(pattern: &[&str], node: &[&str]) -> bool {
    match (pattern.split_first(), node.split_first()) {
        (None, None) => true,
        (Some((&"**", rest)), _) => (0..=node.len()).any(|skipped| matches(rest, &node[skipped..])),
        (Some((p, pattern)), Some((n, node))) => (*p == "*" || p == n) && matches(pattern, node),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unheard(name: &str, fqn: &str) -> bool {
        unheard_pattern(&format!("# a: b\n{name}:\n  ros__parameters:\n    gains:\n      damping: 1.0\n"), fqn)
            .is_some()
    }

    #[test]
    fn patterns_that_mean_the_node_are_found() {
        for pattern in ["/left/*", "/*/haptic_servo", "/**/haptic_servo", "'/left/**'", "\"/**/*\"", "/*/*"] {
            assert!(unheard(pattern, "/left/haptic_servo"), "{pattern}");
        }
        assert!(unheard("/**/haptic_servo", "/haptic_servo"), "no level at all");
    }

    #[test]
    fn what_is_heard_and_what_means_others_passes() {
        for name in ["/**", "**", "/left/haptic_servo", "haptic_servo", "/right/*", "/*", "/**/haptic_device", "/*/*/*"]
        {
            assert!(!unheard(name, "/left/haptic_servo"), "{name}");
        }
    }

    #[test]
    fn levels_are_joined_to_a_name() {
        let text = "left:\n  '*':\n    ros__parameters: {a: 1}\n/right/x:\n  ros__parameters:\n    b: 2\n";
        assert_eq!(node_names(text), ["left/*", "/right/x"]);
        assert_eq!(unheard_pattern(text, "/left/haptic_servo").as_deref(), Some("left/*"));
    }
}
