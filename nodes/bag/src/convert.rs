//! `servo::TickRecord` to its message and back, bit for bit.

use crate::msg;
use crate::{BagError, msg::Message};
use cspace::BasicContact;
use haptics::{ContactFormation, ContactPoint, FormationKind, Gains, LawKind};
use servo::{Health, TickInput, TickRecord};

/// A tick as its message. Exact: [`tick_from_msg`] gives the same bits back (stamps within the range of ROS time).
#[must_use]
pub fn tick_to_msg(tick: &TickRecord) -> msg::TickRecord {
    let input = &tick.input;
    msg::TickRecord {
        sequence: input.sequence,
        stamp: input.stamp.into(),
        dt: input.dt,
        sample: sample_to_msg(&input.sample),
        gains: gains_to_msg(&input.gains),
        enabled: input.enabled,
        reset_count: input.reset_count,
        outside: input.outside.0,
        remote: input.remote.into(),
        pose: tick.hip.into(),
        twist: tick.twist.into(),
        proxy_pose: tick.proxy.into(),
        depth: tick.depth,
        kind: tick.formation.kind as u8,
        contacts: tick.formation.points().iter().map(contact_to_msg).collect(),
        law_wrench: tick.law_wrench.into(),
        out_wrench: tick.out_wrench.into(),
        energy: tick.energy,
        health: tick.health.0,
        wakeup_ns: tick.wakeup_ns,
        compute_ns: tick.compute_ns,
    }
}

/// The reverse of [`tick_to_msg`].
///
/// # Errors
/// If an enumeration has a value that this version does not know, or there are more contacts than a tick carries.
pub fn tick_from_msg(m: &msg::TickRecord) -> Result<TickRecord, BagError> {
    Ok(TickRecord {
        input: TickInput {
            sequence: m.sequence,
            stamp: m.stamp.into(),
            dt: m.dt,
            sample: sample_from_msg(&m.sample),
            gains: gains_from_msg(&m.gains)?,
            enabled: m.enabled,
            reset_count: m.reset_count,
            outside: Health(m.outside),
            remote: m.remote.into(),
        },
        hip: m.pose.into(),
        twist: m.twist.into(),
        proxy: m.proxy_pose.into(),
        depth: m.depth,
        formation: formation_from_msg(m.kind, &m.contacts)?,
        law_wrench: m.law_wrench.into(),
        out_wrench: m.out_wrench.into(),
        energy: m.energy,
        health: Health(m.health),
        wakeup_ns: m.wakeup_ns,
        compute_ns: m.compute_ns,
    })
}

fn sample_to_msg(s: &device::Sample) -> msg::DeviceSample {
    msg::DeviceSample {
        sequence: s.sequence,
        stamp: s.stamp.into(),
        pose: s.pose.into(),
        twist: s.twist.into(),
        has_twist: s.has_twist,
        buttons: s.buttons,
        connected: s.connected,
    }
}

fn sample_from_msg(m: &msg::DeviceSample) -> device::Sample {
    device::Sample {
        sequence: m.sequence,
        stamp: m.stamp.into(),
        pose: m.pose.into(),
        twist: m.twist.into(),
        has_twist: m.has_twist,
        buttons: m.buttons,
        connected: m.connected,
    }
}

/// Gains as their message.
#[must_use]
pub fn gains_to_msg(g: &Gains) -> msg::Gains {
    msg::Gains {
        law: g.law as u8,
        stiffness: g.stiffness,
        damping: g.damping,
        rotation_stiffness: g.rotation_stiffness,
        rotation_damping: g.rotation_damping,
        blend_depth: g.blend_depth,
        max_force: g.max_force,
        max_torque: g.max_torque,
        max_force_rate: g.max_force_rate,
        max_torque_rate: g.max_torque_rate,
        ramp_time: g.ramp_time,
        friction_static: g.friction_static,
        friction_kinetic: g.friction_kinetic,
        passivity: g.passivity,
        proxy_speed: g.proxy_speed,
    }
}

fn gains_from_msg(m: &msg::Gains) -> Result<Gains, BagError> {
    let law = match m.law {
        0 => LawKind::Paper,
        1 => LawKind::Pstar,
        2 => LawKind::Blended,
        3 => LawKind::Proxy,
        n => return Err(BagError::message(msg::Gains::NAME, format!("law {n} is not known"))),
    };
    Ok(Gains {
        law,
        stiffness: m.stiffness,
        damping: m.damping,
        rotation_stiffness: m.rotation_stiffness,
        rotation_damping: m.rotation_damping,
        blend_depth: m.blend_depth,
        max_force: m.max_force,
        max_torque: m.max_torque,
        max_force_rate: m.max_force_rate,
        max_torque_rate: m.max_torque_rate,
        ramp_time: m.ramp_time,
        friction_static: m.friction_static,
        friction_kinetic: m.friction_kinetic,
        passivity: m.passivity,
        proxy_speed: m.proxy_speed,
    })
}

/// A basic contact as its message.
#[must_use]
pub fn basic_contact_to_msg(contact: &BasicContact) -> msg::BasicContact {
    let (feature_a, feature_b) = contact.features();
    let kind = match contact {
        BasicContact::TypeA { .. } => 0,
        BasicContact::TypeB { .. } => 1,
        BasicContact::TypeC { .. } => 2,
    };
    msg::BasicContact { kind, feature_a, feature_b }
}

/// A contact point as its message.
#[must_use]
pub fn contact_to_msg(p: &ContactPoint) -> msg::ContactPoint {
    msg::ContactPoint {
        part_a: p.part_a,
        piece_b: p.piece_b,
        contact: basic_contact_to_msg(&p.contact),
        point: p.point_w.into(),
        normal: p.normal_w.into(),
        distance: p.distance,
        kind: p.kind as u8,
    }
}

fn contact_from_msg(m: &msg::ContactPoint) -> Result<ContactPoint, BagError> {
    let letter = match m.contact.kind {
        0 => 'A',
        1 => 'B',
        2 => 'C',
        n => return Err(BagError::message(msg::BasicContact::NAME, format!("type {n} is not known"))),
    };
    let contact = BasicContact::from_parts(letter, m.contact.feature_a, m.contact.feature_b)
        .ok_or_else(|| BagError::message(msg::BasicContact::NAME, "no such contact"))?;
    Ok(ContactPoint {
        part_a: m.part_a,
        piece_b: m.piece_b,
        contact,
        point_w: m.point.into(),
        normal_w: m.normal.into(),
        distance: m.distance,
        kind: formation_kind(m.kind)?,
    })
}

fn formation_from_msg(kind: u8, contacts: &[msg::ContactPoint]) -> Result<ContactFormation, BagError> {
    let mut formation = ContactFormation::FREE;
    formation.kind = formation_kind(kind)?;
    for contact in contacts {
        if !formation.push(contact_from_msg(contact)?) {
            let reason = format!("{} contacts, at most {} fit", contacts.len(), haptics::MAX_CONTACTS);
            return Err(BagError::message(msg::TickRecord::NAME, reason));
        }
    }
    Ok(formation)
}

fn formation_kind(kind: u8) -> Result<FormationKind, BagError> {
    Ok(match kind {
        0 => FormationKind::Free,
        1 => FormationKind::VertexFace,
        2 => FormationKind::EdgeEdge,
        3 => FormationKind::EdgeFace,
        4 => FormationKind::FaceFace,
        n => return Err(BagError::message(msg::PrincipalContact::NAME, format!("kind {n} is not known"))),
    })
}
