use super::Declared;
use super::patterns::unheard_pattern;
use super::wire::{descriptor, from_message, list, value_message};
use crate::{Failure, Inbox, Outcome};
use r2r::rcl_interfaces::msg::{Parameter as ParameterMsg, ParameterEvent, SetParametersResult};
use r2r::rcl_interfaces::srv::{
    DescribeParameters, GetParameterTypes, GetParameters, ListParameters, SetParameters, SetParametersAtomically,
};
use r2r::{Node, ParameterValue, Publisher, QosProfile, ServiceRequest};
use spatial::Stamp;
use std::collections::BTreeMap;

/// New values that a client asks for, checked one by one: the node takes all of them or refuses with a reason.
pub type Change<'a> = &'a mut dyn FnMut(&BTreeMap<String, ParameterValue>) -> Result<(), String>;

/// The parameters of a node and the six services that everybody's tools speak.
pub struct ParameterServer {
    declared: BTreeMap<String, Declared>,
    values: BTreeMap<String, ParameterValue>,
    node: String,
    get: Inbox<ServiceRequest<GetParameters::Service>>,
    types: Inbox<ServiceRequest<GetParameterTypes::Service>>,
    list: Inbox<ServiceRequest<ListParameters::Service>>,
    describe: Inbox<ServiceRequest<DescribeParameters::Service>>,
    set: Inbox<ServiceRequest<SetParameters::Service>>,
    set_all: Inbox<ServiceRequest<SetParametersAtomically::Service>>,
    events: Publisher<ParameterEvent>,
}

impl ParameterServer {
    /// Takes what the command line and the parameter files set, checks it against what is declared and offers the
    /// services.
    ///
    /// # Errors
    /// A parameter that nobody declared, of the wrong type or out of its range.
    pub fn new(node: &mut Node, declared: Vec<Declared>) -> Outcome<Self> {
        let mut declared: BTreeMap<String, Declared> = declared.into_iter().map(|d| (d.name.clone(), d)).collect();
        declared.entry("use_sim_time".into()).or_insert_with(|| {
            Declared::fixed(
                "use_sim_time",
                ParameterValue::Bool(false),
                "whether time comes from /clock; not followed where a hand is at the node",
            )
        });
        let name = node.fully_qualified_name()?;
        refuse_unheard(std::env::args(), &name)?;
        let values = starting_values(&declared, &overrides(node)).map_err(|e| Failure::new(format!("{name}: {e}")))?;
        let qos = QosProfile::parameters;
        Ok(Self {
            get: Inbox::new(node.create_service::<GetParameters::Service>("~/get_parameters", qos())?),
            types: Inbox::new(node.create_service::<GetParameterTypes::Service>("~/get_parameter_types", qos())?),
            list: Inbox::new(node.create_service::<ListParameters::Service>("~/list_parameters", qos())?),
            describe: Inbox::new(node.create_service::<DescribeParameters::Service>("~/describe_parameters", qos())?),
            set: Inbox::new(node.create_service::<SetParameters::Service>("~/set_parameters", qos())?),
            set_all: Inbox::new(
                node.create_service::<SetParametersAtomically::Service>("~/set_parameters_atomically", qos())?,
            ),
            events: node.create_publisher("/parameter_events", QosProfile::parameter_events())?,
            declared,
            values,
            node: name,
        })
    }

    /// All values, by name.
    #[must_use]
    pub fn values(&self) -> &BTreeMap<String, ParameterValue> {
        &self.values
    }

    /// A text; empty if there is none of that name.
    #[must_use]
    pub fn text(&self, name: &str) -> String {
        match self.values.get(name) {
            Some(ParameterValue::String(s)) => s.clone(),
            _ => String::new(),
        }
    }

    /// A number; NaN if there is none of that name.
    #[must_use]
    pub fn number(&self, name: &str) -> f64 {
        match self.values.get(name) {
            Some(ParameterValue::Double(x)) => *x,
            Some(ParameterValue::Integer(i)) => *i as f64,
            _ => f64::NAN,
        }
    }

    /// A switch; false if there is none of that name.
    #[must_use]
    pub fn switch(&self, name: &str) -> bool {
        matches!(self.values.get(name), Some(ParameterValue::Bool(true)))
    }

    /// A list of texts; empty if there is none of that name.
    #[must_use]
    pub fn texts(&self, name: &str) -> Vec<String> {
        match self.values.get(name) {
            Some(ParameterValue::StringArray(v)) => v.clone(),
            _ => Vec::new(),
        }
    }

    /// Answers what has come. `change` is asked before new values are taken.
    ///
    /// # Errors
    /// The middleware refuses to send.
    pub fn serve(&mut self, now: Stamp, change: Change<'_>) -> Outcome<()> {
        while let Some(r) = self.get.take() {
            let values = r.message.names.iter().map(|n| value_message(self.values.get(n))).collect();
            r.respond(GetParameters::Response { values })?;
        }
        while let Some(r) = self.types.take() {
            let types = r.message.names.iter().map(|n| value_message(self.values.get(n)).type_).collect();
            r.respond(GetParameterTypes::Response { types })?;
        }
        while let Some(r) = self.list.take() {
            let result = list(self.values.keys(), &r.message.prefixes, r.message.depth);
            r.respond(ListParameters::Response { result })?;
        }
        while let Some(r) = self.describe.take() {
            let descriptors = r.message.names.iter().map(|n| descriptor(n, self.declared.get(n))).collect();
            r.respond(DescribeParameters::Response { descriptors })?;
        }
        while let Some(r) = self.set.take() {
            let results =
                r.message.parameters.iter().map(|p| self.try_set(std::slice::from_ref(p), now, change)).collect();
            r.respond(SetParameters::Response { results })?;
        }
        while let Some(r) = self.set_all.take() {
            let result = self.try_set(&r.message.parameters, now, change);
            r.respond(SetParametersAtomically::Response { result })?;
        }
        Ok(())
    }

    fn try_set(&mut self, wanted: &[ParameterMsg], now: Stamp, change: Change<'_>) -> SetParametersResult {
        let outcome = check(&self.declared, &self.values, wanted).and_then(|new| {
            if !new.is_empty() {
                change(&new)?;
            }
            Ok(new)
        });
        match outcome {
            Err(reason) => SetParametersResult { successful: false, reason },
            Ok(new) => {
                let changed_parameters = new
                    .iter()
                    .map(|(name, v)| ParameterMsg { name: name.clone(), value: value_message(Some(v)) })
                    .collect();
                self.values.extend(new);
                let event = ParameterEvent {
                    stamp: crate::convert::time(now),
                    node: self.node.clone(),
                    changed_parameters,
                    ..Default::default()
                };
                // An event that nobody hears changes nothing about the value that was taken.
                let _ = self.events.publish(&event);
                SetParametersResult { successful: true, reason: String::new() }
            }
        }
    }
}

/// Refuses parameter files that mean this node by a pattern which the binding passes over.
fn refuse_unheard(arguments: impl Iterator<Item = String>, node: &str) -> Outcome<()> {
    let arguments: Vec<String> = arguments.collect();
    for pair in arguments.windows(2).filter(|pair| pair[0] == "--params-file") {
        // A file that cannot be read was refused before.
        let text = std::fs::read_to_string(&pair[1]).unwrap_or_default();
        if let Some(pattern) = unheard_pattern(&text, node) {
            return Err(Failure::new(format!(
                "{}: parameters of `{pattern}` would not be heard; write `/**` or `{node}` instead",
                pair[1]
            )));
        }
    }
    Ok(())
}

/// What the command line and the parameter files set for this node.
fn overrides(node: &Node) -> BTreeMap<String, ParameterValue> {
    node.params.lock().map(|p| p.iter().map(|(k, v)| (k.clone(), v.value.clone())).collect()).unwrap_or_default()
}

fn starting_values(
    declared: &BTreeMap<String, Declared>,
    overrides: &BTreeMap<String, ParameterValue>,
) -> Result<BTreeMap<String, ParameterValue>, String> {
    let mut values: BTreeMap<_, _> = declared.iter().map(|(k, d)| (k.clone(), d.default.clone())).collect();
    for (name, value) in overrides {
        // Set by tools for every node, of no concern to ours.
        if name.starts_with("qos_overrides.") || name == "start_type_description_service" {
            continue;
        }
        let d = declared.get(name).ok_or_else(|| unknown(declared, name))?;
        values.insert(name.clone(), d.accept(value)?);
    }
    Ok(values)
}

fn unknown(declared: &BTreeMap<String, Declared>, name: &str) -> String {
    let last = name.rsplit('.').next().unwrap_or(name);
    match declared.keys().find(|k| k.rsplit('.').next() == Some(last) || k.starts_with(name)) {
        Some(near) => format!("there is no parameter `{name}`; did you mean `{near}`?"),
        None => format!("there is no parameter `{name}`; `ros2 param list` and the files in config/ name them all"),
    }
}

/// The wanted values that differ from the present ones, in the parameters' own types.
fn check(
    declared: &BTreeMap<String, Declared>,
    present: &BTreeMap<String, ParameterValue>,
    wanted: &[ParameterMsg],
) -> Result<BTreeMap<String, ParameterValue>, String> {
    let mut new = BTreeMap::new();
    for p in wanted {
        let d = declared.get(&p.name).ok_or_else(|| unknown(declared, &p.name))?;
        let value = d.accept(&from_message(&p.value))?;
        if present.get(&p.name) == Some(&value) {
            continue;
        }
        if !d.live {
            return Err(format!("parameter `{}` needs a restart of the node to change", p.name));
        }
        new.insert(p.name.clone(), value);
    }
    Ok(new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ParameterValue as V;

    fn tree() -> BTreeMap<String, Declared> {
        [
            Declared::fixed("scene", V::String(String::new()), "scene file"),
            Declared::fixed("gains.damping", V::Double(1.0), "N.s/m").within(0.0, 50.0).live(),
            Declared::fixed("gains.stiffness", V::Double(1000.0), "N/m").within(0.0, 1e5).live(),
        ]
        .into_iter()
        .map(|d| (d.name.clone(), d))
        .collect()
    }

    fn wanted(name: &str, value: V) -> ParameterMsg {
        ParameterMsg { name: name.to_owned(), value: value_message(Some(&value)) }
    }

    #[test]
    fn an_unknown_parameter_at_the_start_is_an_error_that_names_a_near_one() {
        let o = [("damping".to_owned(), V::Double(2.0))].into();
        assert!(starting_values(&tree(), &o).unwrap_err().contains("gains.damping"));
    }

    #[test]
    fn a_fixed_parameter_is_refused_unless_it_stays_what_it_is() {
        let present = starting_values(&tree(), &BTreeMap::new()).unwrap();
        assert!(check(&tree(), &present, &[wanted("scene", V::String("x".into()))]).unwrap_err().contains("restart"));
        assert!(check(&tree(), &present, &[wanted("scene", V::String(String::new()))]).unwrap().is_empty());
    }

    #[test]
    fn one_bad_value_refuses_the_whole_set() {
        let present = starting_values(&tree(), &BTreeMap::new()).unwrap();
        let both = [wanted("gains.damping", V::Double(2.0)), wanted("gains.stiffness", V::Double(f64::NAN))];
        assert!(check(&tree(), &present, &both).unwrap_err().contains("gains.stiffness"));
    }

    #[test]
    fn a_pattern_that_would_not_be_heard_is_refused_with_its_file() {
        let file = std::env::temp_dir().join(format!("unheard_pattern_{}.yaml", std::process::id()));
        std::fs::write(&file, "/**/haptic_servo:\n  ros__parameters:\n    law: paper\n").unwrap();
        let name = file.display().to_string();
        let arguments = |n: &str| ["x", "--ros-args", "--params-file", n].map(str::to_owned).into_iter();
        let refused = refuse_unheard(arguments(&name), "/left/haptic_servo").unwrap_err().to_string();
        assert!(refused.contains(&name) && refused.contains("`/left/haptic_servo`"), "{refused}");
        assert!(refuse_unheard(arguments(&name), "/haptic_device").is_ok());
        std::fs::remove_file(&file).unwrap();
        assert!(refuse_unheard(arguments(&name), "/left/haptic_servo").is_ok());
    }
}
