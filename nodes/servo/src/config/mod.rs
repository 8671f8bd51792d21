//! Configuration: parameters as a schema in one place, parsed once into checked types.

mod document;
mod node_switch;
mod param;
mod schema;
mod tree;
mod values;

pub use document::{markdown_table, parameter_file, yaml_template};
pub use node_switch::{NodeSwitch, node_switches};
pub use param::{ParamError, ParamSpec, Range, Value};
pub use schema::schema;
use serde_saphyr::{UserMessageFormatter, options::NonFiniteFloatPolicy};
use tree::Tree;
pub use values::{
    Config, ContactsConfig, DeviceConfig, Driver, JumpConfig, MappingConfig, PassivityConfig, RealtimeConfig,
    StabilityConfig, StabilityPolicy,
};

impl Config {
    /// Reads a ROS 2 parameter file: `NODE: {ros__parameters: {...}}`, applied in order, or the bare tree of parameters.
    /// Where a section is of `haptic_servo`, those of other nodes are passed over; else every node name will do. What it does
    /// not name keeps its default; switches of the node alone are passed over.
    ///
    /// # Errors
    /// The first parameter that is unknown, of the wrong type or out of range, or why the text is no parameter file.
    pub fn from_yaml(yaml: &str) -> Result<Self, ParamError> {
        let mut options = serde_saphyr::Options::default();
        options.with_snippet = false;
        // The schema refuses what is not finite, and knows the parameter's name.
        options.non_finite_float_policy = NonFiniteFloatPolicy::PassThrough;
        let tree: Tree = serde_saphyr::from_str_with_options(yaml, options).map_err(|e| {
            ParamError::Syntax(format!("not a parameter file: {}", e.render_with_formatter(&UserMessageFormatter)))
        })?;
        let mut config = Self::default();
        let mut set = |name: &str, value: &Value| {
            if node_switch::is_node_switch(name, value)? { Ok(()) } else { config.set(name, value) }
        };
        let Tree::Node(branches) = &tree else {
            return Err(ParamError::Syntax("not a parameter file: need a map".into()));
        };
        let mut sections: Vec<(&str, &Tree)> = Vec::new();
        for (node, branch) in branches {
            if let Tree::Node(inner) = branch {
                let parameters = inner.iter().filter(|(key, _)| key == "ros__parameters");
                sections.extend(parameters.map(|(_, tree)| (node.rsplit('/').next().unwrap_or_default(), tree)));
            }
        }
        if sections.is_empty() {
            tree.walk("", &mut set)?;
        }
        if sections.iter().any(|(node, _)| *node == "haptic_servo") {
            sections.retain(|(node, _)| ["haptic_servo", "*", "**"].contains(node));
        }
        sections.into_iter().try_for_each(|(_, parameters)| parameters.walk("", &mut set))?;
        Ok(config)
    }

    /// Sets one parameter, if the value is allowed.
    ///
    /// # Errors
    /// Unknown name, wrong type, out of range, NaN; nothing is changed then.
    pub fn set(&mut self, name: &str, value: &Value) -> Result<(), ParamError> {
        let spec = spec(name)?;
        let value = spec.check(value)?;
        (spec.set)(self, &value);
        Ok(())
    }

    /// The value of one parameter.
    ///
    /// # Errors
    /// Unknown name.
    pub fn get(&self, name: &str) -> Result<Value, ParamError> {
        Ok((spec(name)?.get)(self))
    }

    /// All parameters as a ROS 2 parameter file that reads back to the same configuration: what a bag carries.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        document::yaml(self)
    }
}

/// The parameter of that name.
///
/// # Errors
/// There is none; the error names the nearest one.
pub fn spec(name: &str) -> Result<&'static ParamSpec, ParamError> {
    schema().iter().find(|s| s.name == name).ok_or_else(|| {
        let last = |n: &str| n.rsplit('.').next().unwrap_or_default().to_owned();
        let suggestion = schema().iter().map(|s| s.name).find(|s| last(s) == last(name));
        ParamError::Unknown { name: name.into(), suggestion }
    })
}

#[cfg(test)]
mod tests;
