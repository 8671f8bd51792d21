use super::{ParamError, Value};
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// A YAML tree of parameters, order kept.
pub enum Tree {
    /// A value.
    Leaf(Value),
    /// A list, whatever it holds: other nodes have such parameters, the servo has none.
    List,
    /// Named branches.
    Node(Vec<(String, Tree)>),
}

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TreeVisitor)
    }
}

struct TreeVisitor;

impl<'de> Visitor<'de> for TreeVisitor {
    type Value = Tree;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a parameter: bool, number or text, or a map of them")
    }

    fn visit_bool<E: Error>(self, b: bool) -> Result<Tree, E> {
        Ok(Tree::Leaf(Value::Bool(b)))
    }

    fn visit_i64<E: Error>(self, i: i64) -> Result<Tree, E> {
        Ok(Tree::Leaf(Value::Int(i)))
    }

    fn visit_u64<E: Error>(self, i: u64) -> Result<Tree, E> {
        i64::try_from(i).map(|i| Tree::Leaf(Value::Int(i))).map_err(|_| E::custom(format!("{i} is too large")))
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<Tree, E> {
        Ok(Tree::Leaf(Value::Float(x)))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Tree, E> {
        Ok(Tree::Leaf(Value::Text(text.into())))
    }

    fn visit_unit<E: Error>(self) -> Result<Tree, E> {
        Ok(Tree::Node(Vec::new()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Tree, A::Error> {
        while list.next_element::<IgnoredAny>()?.is_some() {}
        Ok(Tree::List)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Tree, A::Error> {
        let mut branches = Vec::new();
        while let Some(branch) = map.next_entry()? {
            branches.push(branch);
        }
        Ok(Tree::Node(branches))
    }
}

impl Tree {
    /// Calls `leaf` with the dotted name and value of every leaf.
    ///
    /// # Errors
    /// The first that `leaf` gives, or a list.
    pub fn walk(
        &self,
        name: &str,
        leaf: &mut impl FnMut(&str, &Value) -> Result<(), ParamError>,
    ) -> Result<(), ParamError> {
        match self {
            Self::List => Err(ParamError::Syntax(format!("parameter `{name}` is a list: the servo has no such"))),
            Self::Leaf(value) => leaf(name, value),
            Self::Node(branches) => branches.iter().try_for_each(|(key, branch)| {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                branch.walk(&name, leaf)
            }),
        }
    }
}
