use r2r::ParameterValue;

/// One parameter of a node: what it may be, and whether it may change while the node runs.
#[derive(Clone, Debug)]
pub struct Declared {
    /// Name, with dots between the levels of the tree.
    pub name: String,
    /// The value when nobody sets one; its type is the parameter's type.
    pub default: ParameterValue,
    /// Smallest and largest value of a number, both allowed; infinite ends are open.
    pub range: Option<(f64, f64)>,
    /// The texts that are allowed; empty if any is.
    pub choices: Vec<String>,
    /// Meaning and unit, in a line.
    pub description: String,
    /// Whether it may change while the node runs.
    pub live: bool,
}

impl Declared {
    /// A parameter that is read once, at the start.
    #[must_use]
    pub fn fixed(name: &str, default: ParameterValue, description: &str) -> Self {
        Self {
            name: name.to_owned(),
            default,
            range: None,
            choices: Vec::new(),
            description: description.to_owned(),
            live: false,
        }
    }

    /// The same, but it may change while the node runs.
    #[must_use]
    pub fn live(mut self) -> Self {
        self.live = true;
        self
    }

    /// The same, limited to `[min, max]`.
    #[must_use]
    pub fn within(mut self, min: f64, max: f64) -> Self {
        self.range = Some((min, max));
        self
    }

    /// The same, limited to these texts.
    #[must_use]
    pub fn one_of(mut self, choices: &[&str]) -> Self {
        self.choices = choices.iter().map(|c| (*c).to_owned()).collect();
        self
    }

    /// `value` in the parameter's own type, or why it is refused.
    ///
    /// A whole number is taken where a real one is wanted, for `-p damping:=1` is what people write, and an empty array
    /// has no type of its own.
    ///
    /// # Errors
    /// Wrong type, not a number, out of range, not among the choices.
    pub fn accept(&self, value: &ParameterValue) -> Result<ParameterValue, String> {
        use ParameterValue as V;
        let value = match (&self.default, value) {
            (V::Double(_), V::Integer(i)) => V::Double(*i as f64),
            (V::DoubleArray(_), V::IntegerArray(v)) => V::DoubleArray(v.iter().map(|i| *i as f64).collect()),
            (V::StringArray(_), V::NotSet) => V::StringArray(Vec::new()),
            (V::DoubleArray(_), V::NotSet) => V::DoubleArray(Vec::new()),
            (d, v) if std::mem::discriminant(d) == std::mem::discriminant(v) => v.clone(),
            (_, V::NotSet) => return Err(format!("parameter `{}` cannot be undeclared: the node needs it", self.name)),
            (d, v) => {
                return Err(format!("parameter `{}` is of type {}, got {}", self.name, d.type_name(), v.type_name()));
            }
        };
        let numbers: Vec<f64> = match &value {
            V::Double(x) => vec![*x],
            V::Integer(i) => vec![*i as f64],
            V::DoubleArray(v) => v.clone(),
            V::IntegerArray(v) => v.iter().map(|i| *i as f64).collect(),
            _ => Vec::new(),
        };
        for x in numbers {
            if x.is_nan() {
                return Err(format!("parameter `{}` is not a number", self.name));
            }
            if let Some((min, max)) = self.range
                && !(x >= min && x <= max)
            {
                return Err(format!("parameter `{}` = {x} is out of its range {min} .. {max}", self.name));
            }
        }
        if let V::String(s) = &value
            && !self.choices.is_empty()
            && !self.choices.contains(s)
        {
            return Err(format!("parameter `{}` = `{s}` is none of {}", self.name, self.choices.join(", ")));
        }
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ParameterValue as V;

    fn gain() -> Declared {
        Declared::fixed("gains.damping", V::Double(1.0), "N.s/m").within(0.0, 50.0)
    }

    #[test]
    fn a_whole_number_passes_for_a_real_one() {
        assert_eq!(gain().accept(&V::Integer(2)), Ok(V::Double(2.0)));
    }

    #[test]
    fn not_a_number_and_out_of_range_are_refused_with_the_name() {
        for bad in [f64::NAN, -1.0, 50.1, f64::INFINITY] {
            assert!(gain().accept(&V::Double(bad)).unwrap_err().contains("gains.damping"), "{bad}");
        }
        assert!(gain().accept(&V::String("1".into())).unwrap_err().contains("double"));
    }

    #[test]
    fn a_text_is_one_of_its_choices() {
        let law = Declared::fixed("law", V::String("proxy".into()), "").one_of(&["paper", "proxy"]);
        assert!(law.accept(&V::String("paper".into())).is_ok());
        assert!(law.accept(&V::String("papers".into())).unwrap_err().contains("paper, proxy"));
    }
}
