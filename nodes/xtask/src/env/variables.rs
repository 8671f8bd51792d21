//! Environment variables that differ from the caller's.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fmt::Display;
use std::path::Path;
use std::process::Command;

/// What names a profile of Fast DDS: the name until version 2, and the one since.
const PROFILES: [&str; 2] = ["FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"];

/// The variables to set on top of the inherited environment.
#[derive(Debug, Clone, Default)]
pub struct Variables(BTreeMap<String, String>);

impl Variables {
    /// Sets one variable.
    pub fn set(&mut self, name: &str, value: impl Display) {
        self.0.insert(name.to_owned(), value.to_string());
    }

    /// The value: ours, else the inherited one.
    pub fn get(&self, name: &str) -> Option<String> {
        self.0.get(name).cloned().or_else(|| std::env::var(name).ok()).filter(|value| !value.is_empty())
    }

    /// Puts a folder in front of a colon-separated list, keeping what is there or inherited.
    pub fn prepend(&mut self, name: &str, folder: &Path) {
        let value = match self.get(name) {
            Some(rest) => format!("{}:{rest}", folder.display()),
            None => folder.display().to_string(),
        };
        self.set(name, value);
    }

    /// Gives the variables to a command.
    pub fn apply<'c>(&self, command: &'c mut Command) -> &'c mut Command {
        command.envs(&self.0)
    }

    /// A command with these variables, found on their `PATH` rather than on ours.
    pub fn command(&self, program: impl AsRef<OsStr>) -> Command {
        let mut command = Command::new(program);
        self.apply(&mut command);
        command
    }

    /// A command with these variables that talks to nodes of this machine in one domain alone.
    pub fn local_command(&self, program: impl AsRef<OsStr>, domain: u16) -> Command {
        let mut command = self.command(program);
        command
            .env("ROS_DOMAIN_ID", domain.to_string())
            .env_remove("ROS_LOCALHOST_ONLY")
            .env_remove("ROS_STATIC_PEERS");
        let fast_dds = self.get("RMW_IMPLEMENTATION").is_none_or(|name| name.contains("fastrtps"));
        if fast_dds {
            // A killed process leaves its shared memory locked, and others of Fast DDS wait on it or go deaf: one that dies
            // must not take the rest along. Asked for this machine alone, ROS adds shared memory whatever the variables of
            // Fast DDS say; a profile that it leaves as it is gives both.
            let profile = crate::workspace::root().join("config/fastdds_loopback.xml");
            command.env("ROS_AUTOMATIC_DISCOVERY_RANGE", "SYSTEM_DEFAULT");
            command.envs(PROFILES.map(|name| (name, profile.clone())));
        } else if self.get("ROS_DISTRO").as_deref() == Some("humble") {
            command.env("ROS_LOCALHOST_ONLY", "1"); // Humble knows no discovery range; later ones warn of this name.
        } else {
            command.env("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST");
        }
        command
    }

    /// As lines for a POSIX shell.
    pub fn to_shell(&self) -> String {
        self.0.iter().map(|(name, value)| format!("export {name}='{}'\n", value.replace('\'', r"'\''"))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shell_quotes_survive() {
        let mut variables = Variables::default();
        variables.set("A", "it's");
        assert_eq!(variables.to_shell(), "export A='it'\\''s'\n");
    }

    #[test]
    fn nodes_of_this_machine_alone_share_no_memory() {
        let mut variables = Variables::default();
        let of = |variables: &Variables, name: &str| {
            let command = variables.local_command("node", 7);
            let value = command.get_envs().find(|(key, _)| *key == name).and_then(|(_, value)| value);
            value.map(|v| v.to_string_lossy().into_owned())
        };
        variables.set("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp");
        assert_eq!(of(&variables, "ROS_AUTOMATIC_DISCOVERY_RANGE").as_deref(), Some("SYSTEM_DEFAULT"));
        assert!(PROFILES.iter().all(|name| Path::new(&of(&variables, name).unwrap()).is_file()));
        variables.set("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp");
        variables.set("ROS_DISTRO", "jazzy");
        assert_eq!(of(&variables, "ROS_AUTOMATIC_DISCOVERY_RANGE").as_deref(), Some("LOCALHOST"));
        assert_eq!(of(&variables, "FASTRTPS_DEFAULT_PROFILES_FILE"), None);
    }

    #[test]
    fn prepend_keeps_order() {
        let mut variables = Variables::default();
        variables.prepend("CSPACE_TEST_LIST", Path::new("/b"));
        variables.prepend("CSPACE_TEST_LIST", Path::new("/a"));
        assert_eq!(variables.get("CSPACE_TEST_LIST").as_deref(), Some("/a:/b"));
    }
}
