//! A blueprint written view by view: rerun's own builder reaches neither the eye, the grid, the background, the time axis
//! nor an entity's time range.

use rerun::AsComponents;
use rerun::external::re_log_types::{ApplicationId, BlueprintActivationCommand, LogMsg};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, PanelBlueprint, TimePanelBlueprint, ViewBlueprint, ViewContents, ViewportBlueprint,
};
use rerun::external::re_sdk_types::blueprint::components::{
    ContainerKind, IncludedContent, PanelState, QueryExpression,
};
use rerun::{RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

/// A view or a container of views.
pub(crate) enum Node {
    View(View),
    Row(Vec<(f32, Node)>),
    Column(Vec<(f32, Node)>),
    Tabs(Vec<Node>),
}

/// One view: its class, title, origin, contents, properties and per-entity overrides.
pub(crate) struct View {
    class: &'static str,
    title: String,
    origin: String,
    contents: Vec<String>,
    properties: Vec<(&'static str, Box<dyn AsComponents>)>,
    entities: Vec<(String, Box<dyn AsComponents>)>,
}

impl View {
    pub(crate) fn new(class: &'static str, title: &str, origin: &str) -> Self {
        Self {
            class,
            title: title.into(),
            origin: origin.into(),
            contents: vec!["$origin/**".into()],
            properties: Vec::new(),
            entities: Vec::new(),
        }
    }

    /// A property archetype of the view, such as its eye or background.
    pub(crate) fn with(mut self, name: &'static str, property: impl AsComponents + 'static) -> Self {
        self.properties.push((name, Box::new(property)));
        self
    }

    /// Shows this entity and what is below it, instead of everything below the origin.
    pub(crate) fn showing(mut self, root: &str) -> Self {
        self.contents = vec![format!("{root}/**")];
        self
    }

    /// A property of one entity in this view.
    pub(crate) fn entity(mut self, path: &str, property: impl AsComponents + 'static) -> Self {
        self.entities.push((path.into(), Box::new(property)));
        self
    }
}

/// Ids are counted, not drawn: the same layout is the same bytes.
struct Writer {
    stream: RecordingStream,
    next: u128,
}

impl Writer {
    fn id(&mut self) -> ([u8; 16], String) {
        self.next += 1;
        let h = format!("{:032x}", self.next);
        let text = format!("{}-{}-{}-{}-{}", &h[..8], &h[8..12], &h[12..16], &h[16..20], &h[20..]);
        (self.next.to_be_bytes(), text)
    }

    fn write(&mut self, node: &Node) -> RecordingStreamResult<([u8; 16], String)> {
        match node {
            Node::View(view) => self.view(view),
            Node::Row(children) => {
                self.container(ContainerKind::Horizontal, children.iter().map(|(s, n)| (*s, n)).collect())
            }
            Node::Column(children) => {
                self.container(ContainerKind::Vertical, children.iter().map(|(s, n)| (*s, n)).collect())
            }
            Node::Tabs(children) => self.container(ContainerKind::Tabs, children.iter().map(|n| (1.0, n)).collect()),
        }
    }

    fn view(&mut self, view: &View) -> RecordingStreamResult<([u8; 16], String)> {
        let (id, text) = self.id();
        let path = format!("view/{text}");
        let queries = view.contents.iter().map(|q| QueryExpression(q.clone().into()));
        self.stream.log(format!("{path}/ViewContents"), &ViewContents::new(queries))?;
        let head =
            ViewBlueprint::new(view.class).with_display_name(view.title.clone()).with_space_origin(view.origin.clone());
        self.stream.log(path.clone(), &head)?;
        for (name, property) in &view.properties {
            self.stream.log(format!("{path}/{name}"), property.as_ref())?;
        }
        for (entity, property) in &view.entities {
            let entity = entity.trim_start_matches('/');
            self.stream.log(format!("{path}/ViewContents/overrides/{entity}/visualizers"), property.as_ref())?;
        }
        Ok((id, path))
    }

    fn container(
        &mut self,
        kind: ContainerKind,
        children: Vec<(f32, &Node)>,
    ) -> RecordingStreamResult<([u8; 16], String)> {
        let mut paths = Vec::new();
        for (_, child) in &children {
            paths.push(IncludedContent(self.write(child)?.1.into()));
        }
        let shares: Vec<f32> = children.iter().map(|(share, _)| *share).collect();
        let mut container = ContainerBlueprint::new(kind).with_contents(paths);
        match kind {
            ContainerKind::Horizontal => container = container.with_col_shares(shares),
            ContainerKind::Vertical => container = container.with_row_shares(shares),
            _ => {}
        }
        let (id, text) = self.id();
        let path = format!("container/{text}");
        self.stream.log(path.clone(), &container)?;
        Ok((id, path))
    }
}

/// Sends the layout through `recording` and makes it the active one. The side panels are folded away.
pub(crate) fn send(
    recording: &RecordingStream,
    application: &'static str,
    root: Node,
    time_panel: &TimePanelBlueprint,
) -> RecordingStreamResult<()> {
    let builder =
        RecordingStreamBuilder::new(ApplicationId::from(application)).recording_id(format!("{application}-layout"));
    let (stream, storage) = builder.blueprint().memory()?;
    stream.set_time_sequence("blueprint", 0);
    let mut writer = Writer { stream: stream.clone(), next: 0 };
    // The root must be a container.
    let root = match root {
        Node::View(_) => Node::Tabs(vec![root]),
        container => container,
    };
    let (id, _) = writer.write(&root)?;
    let root = rerun::external::re_sdk_types::datatypes::Uuid { bytes: id };
    let viewport = ViewportBlueprint::new().with_root_container(root).with_auto_layout(false).with_auto_views(false);
    stream.log("viewport", &viewport)?;
    for panel in ["blueprint_panel", "selection_panel"] {
        stream.log(panel, &PanelBlueprint::new().with_state(PanelState::Hidden))?;
    }
    stream.log("time_panel", time_panel)?;
    let messages: Vec<LogMsg> = storage.take();
    if let Some(blueprint_id) = messages.first().map(|m| m.store_id().clone()) {
        let activation = BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true };
        recording.send_blueprint(messages, activation);
    }
    Ok(())
}
