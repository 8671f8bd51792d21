use crate::{BasicContact, EdgeId, FaceId, Polyhedron, VertexId};
use glam::DVec2;
use spatial::{DQuat, DVec3};
use std::collections::BTreeSet;

/// One flat face of the C-obstacle `B (+) (-R A)` at one orientation, as a convex polygon (paper, section II).
///
/// In general position exactly one basic contact takes place on it, and the polygon is that contact's C-face. At the
/// orientations of edge-face and face-face contacts (paper, footnote 3) several C-faces are coplanar and overlap; they
/// are then one polygon that names them all.
#[derive(Clone, Debug, PartialEq)]
pub struct CFacePolygon {
    /// The basic contacts that take place on it, in ascending order.
    pub contacts: Vec<BasicContact>,
    /// Outward unit normal, axes of W.
    pub normal_w: DVec3,
    /// Offset of the plane `n.x = offset` in C-space, metres.
    pub offset: f64,
    /// Corners, counter-clockwise seen from outside, metres: positions of A's frame in W.
    pub vertices: Vec<DVec3>,
    /// The vertices of A and of B that touch at each corner. Two polygons are neighbours where they share two corners.
    pub corners: Vec<(VertexId, VertexId)>,
}

impl CFacePolygon {
    /// Area, m^2.
    #[must_use]
    pub fn area(&self) -> f64 {
        let o = self.vertices[0];
        let twice: DVec3 = self.vertices[1..].windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum();
        0.5 * twice.dot(self.normal_w)
    }

    /// Signed distance of `x` to the plane, metres; `< 0` inside.
    #[must_use]
    pub fn distance(&self, x: DVec3) -> f64 {
        self.normal_w.dot(x) - self.offset
    }

    /// Whether an edge is common to both polygons.
    #[must_use]
    pub fn is_neighbor(&self, other: &Self) -> bool {
        self.corners.iter().filter(|c| other.corners.contains(c)).count() >= 2
    }
}

/// Lengths below this part of the bodies' own, and sines below this, count as zero: just above rounding.
const ROUNDING: f64 = 1e-12;

/// Faces whose normals differ by less than this (radians) are drawn as one. A body tilted by `t` against a face makes
/// faces that differ by `t^2`: the bound must lie above [`ROUNDING`], or some of them would be taken for coplanar from one
/// side only and overlap; and not far above, because the hull of two faces that are not quite coplanar is too large, by a
/// part of about `t` of their area.
const COPLANAR: f64 = 1e-10;

/// All faces of the C-obstacle of `a` against `b` at the orientation `rotation` of A: together the closed hull of
/// `{b - R a}`.
///
/// Each comes straight from the features that touch on it, nothing is clipped: the support sets of B along `n` and of A
/// against it are a vertex, an edge or a face each, and the polygon is their Minkowski sum. Type A: the face of A,
/// mirrored, at the vertex of B. Type B: the face of B shifted by the vertex of A. Type C: the parallelogram of the two
/// edges. Edge against face and face against face come out of the same sum.
///
/// Cost `O(|A| |B|)`, allocates: for pictures and messages, never for the tick.
#[must_use]
pub fn c_face_polygons(a: &Polyhedron, b: &Polyhedron, rotation: DQuat) -> Vec<CFacePolygon> {
    Sum::new(a, b, rotation).polygons()
}

/// The Minkowski sum of B and the mirrored, turned A.
pub(crate) struct Sum<'p> {
    a: &'p Polyhedron,
    b: &'p Polyhedron,
    rotation: DQuat,
    /// `-R a` for every vertex of A.
    mirrored_a: Vec<DVec3>,
    tolerance: f64,
}

impl<'p> Sum<'p> {
    pub(crate) fn new(a: &'p Polyhedron, b: &'p Polyhedron, rotation: DQuat) -> Self {
        let extent = |p: &Polyhedron| {
            let o = p.vertices()[0];
            p.vertices().iter().map(|v| v.distance(o)).fold(0.0, f64::max)
        };
        Self {
            a,
            b,
            rotation,
            mirrored_a: a.vertices().iter().map(|&v| -(rotation * v)).collect(),
            tolerance: ROUNDING * extent(a).max(extent(b)),
        }
    }

    fn polygons(&self) -> Vec<CFacePolygon> {
        let corners: [Vec<VertexId>; 2] = [self.a.corner_ids().collect(), self.b.corner_ids().collect()];
        let mut facets: Vec<Facet> = self.candidate_normals().into_iter().map(|n| self.facet(n, &corners)).collect();
        // Coplanar C-faces have the same support sets, whichever of them proposed the normal.
        facets.sort_by(|p, q| (&p.support_a, &p.support_b).cmp(&(&q.support_a, &q.support_b)));
        facets.dedup_by(|p, q| p.support_a == q.support_a && p.support_b == q.support_b);
        facets.retain(|f| self.spans_face(f));
        self.polygons_of(facets)
    }

    /// Whether the points that touch span a polygon, not a segment or a point.
    pub(crate) fn spans_face(&self, facet: &Facet) -> bool {
        planar_hull(&self.points(facet), facet.normal, self.tolerance).len() >= 3
    }

    /// The polygons of facets that span one each; coplanar ones are one polygon.
    pub(crate) fn polygons_of(&self, facets: Vec<Facet>) -> Vec<CFacePolygon> {
        let mut polygons: Vec<CFacePolygon> = coplanar_groups(facets).iter().filter_map(|g| self.polygon(g)).collect();
        self.unify_corners(&mut polygons);
        polygons
    }

    fn facet(&self, normal: DVec3, [corners_a, corners_b]: &[Vec<VertexId>; 2]) -> Facet {
        Facet {
            normal,
            support_a: support(&self.mirrored_a, corners_a, normal, self.tolerance),
            support_b: support(self.b.vertices(), corners_b, normal, self.tolerance),
        }
    }

    /// The facet across `normal` of which a vertex of A and one of B are known to touch.
    pub(crate) fn facet_at(&self, normal: DVec3, vertex_a: u32, vertex_b: u32) -> Facet {
        let (from_a, from_b) = (VertexId(vertex_a), VertexId(vertex_b));
        Facet {
            normal,
            support_a: support_around(self.a, &self.mirrored_a, from_a, normal, self.tolerance),
            support_b: support_around(self.b, self.b.vertices(), from_b, normal, self.tolerance),
        }
    }

    fn points(&self, facet: &Facet) -> Vec<Corner> {
        let b = self.b.vertices();
        let pairs = facet.support_a.iter().flat_map(|va| facet.support_b.iter().map(move |vb| (*va, *vb)));
        pairs.map(|(va, vb)| (self.mirrored_a[va.index()] + b[vb.index()], (va, vb))).collect()
    }

    /// Every normal that a face of the sum can have: those of the faces, and of the edge pairs whose arcs cross on the
    /// Gauss sphere. Ties are let in; they do not span a polygon and fall out later.
    fn candidate_normals(&self) -> Vec<DVec3> {
        let mirrored: Vec<DVec3> = self.a.faces().map(|f| -(self.rotation * self.a.face_plane(f).normal)).collect();
        let mut normals = mirrored.clone();
        normals.extend(self.b.faces().map(|f| self.b.face_plane(f).normal));
        for edge_a in self.a.edges() {
            let [fa0, fa1] = self.a.edge(edge_a).faces;
            let arc_a = (mirrored[fa0.index()], mirrored[fa1.index()]);
            let [va0, va1] = self.a.edge(edge_a).vertices;
            let along_a = self.mirrored_a[va1.index()] - self.mirrored_a[va0.index()];
            for edge_b in self.b.edges() {
                let [fb0, fb1] = self.b.edge(edge_b).faces;
                let arc_b = (self.b.face_plane(fb0).normal, self.b.face_plane(fb1).normal);
                if !arcs_meet(arc_a, arc_b) {
                    continue;
                }
                let [vb0, vb1] = self.b.edge(edge_b).vertices;
                let along_b = self.b.vertices()[vb1.index()] - self.b.vertices()[vb0.index()];
                let n = along_a.cross(along_b);
                if n.length() > ROUNDING * along_a.length() * along_b.length() {
                    let outward = if n.dot(arc_b.0 + arc_b.1) > 0.0 { n } else { -n };
                    normals.push(outward.normalize());
                }
            }
        }
        normals
    }

    fn polygon(&self, group: &[Facet]) -> Option<CFacePolygon> {
        let normal = group.iter().map(|f| f.normal).sum::<DVec3>().normalize();
        let tolerance = if group.len() == 1 { self.tolerance } else { self.merging_distance() };
        let points: Vec<Corner> = group.iter().flat_map(|f| self.points(f)).collect();
        let hull = planar_hull(&points, normal, tolerance);
        if hull.len() < 3 {
            return None;
        }
        let (vertices, corners): (Vec<_>, Vec<_>) = hull.into_iter().unzip();
        let offset = vertices.iter().map(|v| normal.dot(*v)).sum::<f64>() / vertices.len() as f64;
        let mut contacts: Vec<BasicContact> =
            group.iter().flat_map(|f| self.contacts(&f.support_a, &f.support_b)).collect();
        contacts.sort_unstable();
        contacts.dedup();
        Some(CFacePolygon { contacts, normal_w: normal, offset, vertices, corners })
    }

    /// How far apart corners can be that a merged face takes for one.
    fn merging_distance(&self) -> f64 {
        self.tolerance * (COPLANAR / ROUNDING)
    }

    /// Corners that fall together get one name, so that merged faces still know their neighbours.
    fn unify_corners(&self, polygons: &mut [CFacePolygon]) {
        let distance = 4.0 * self.merging_distance();
        let mut names: Vec<Corner> = Vec::new();
        for polygon in polygons {
            for (vertex, corner) in polygon.vertices.iter().zip(&mut polygon.corners) {
                match names.iter().find(|(at, _)| at.distance_squared(*vertex) < distance * distance) {
                    Some((_, name)) => *corner = *name,
                    None => names.push((*vertex, *corner)),
                }
            }
        }
    }

    /// The basic contacts between the features that two support sets span.
    fn contacts(&self, support_a: &[VertexId], support_b: &[VertexId]) -> Vec<BasicContact> {
        let mut contacts = Vec::new();
        for face_a in spanned_faces(self.a, support_a) {
            contacts.extend(support_b.iter().map(|&vertex_b| BasicContact::TypeA { face_a, vertex_b }));
        }
        for face_b in spanned_faces(self.b, support_b) {
            contacts.extend(support_a.iter().map(|&vertex_a| BasicContact::TypeB { vertex_a, face_b }));
        }
        for edge_a in spanned_edges(self.a, support_a) {
            let [a0, a1] = self.a.edge(edge_a).vertices.map(|v| self.mirrored_a[v.index()]);
            for edge_b in spanned_edges(self.b, support_b) {
                let [b0, b1] = self.b.edge(edge_b).vertices.map(|v| self.b.vertices()[v.index()]);
                let (u, v) = (a1 - a0, b1 - b0);
                if u.cross(v).length() > ROUNDING * u.length() * v.length() {
                    contacts.push(BasicContact::TypeC { edge_a, edge_b });
                }
            }
        }
        contacts
    }
}

/// A plane that touches the sum, and the vertices of A and B that touch it.
pub(crate) struct Facet {
    normal: DVec3,
    support_a: Vec<VertexId>,
    support_b: Vec<VertexId>,
}

impl Facet {
    /// What tells two facets apart.
    pub(crate) fn supports(&self) -> (Vec<VertexId>, Vec<VertexId>) {
        (self.support_a.clone(), self.support_b.clone())
    }
}

/// Facets that are coplanar with one of their group, by single linkage.
fn coplanar_groups(facets: Vec<Facet>) -> Vec<Vec<Facet>> {
    let mut groups: Vec<Vec<Facet>> = Vec::new();
    for facet in facets {
        let near = |g: &Vec<Facet>| g.iter().any(|f| f.normal.distance_squared(facet.normal) < COPLANAR * COPLANAR);
        let (joined, mut apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(near);
        let mut group: Vec<Facet> = joined.into_iter().flatten().collect();
        group.push(facet);
        apart.push(group);
        groups = apart;
    }
    groups
}

fn spanned_faces(p: &Polyhedron, support: &[VertexId]) -> Vec<FaceId> {
    if support.len() < 3 {
        return Vec::new();
    }
    let faces: BTreeSet<FaceId> = support.iter().flat_map(|v| p.vertex_faces(*v)).copied().collect();
    faces.into_iter().filter(|&f| p.face_vertices(f).iter().all(|v| support.contains(v))).collect()
}

fn spanned_edges(p: &Polyhedron, support: &[VertexId]) -> Vec<EdgeId> {
    if support.len() < 2 {
        return Vec::new();
    }
    let edges: BTreeSet<EdgeId> = support.iter().flat_map(|v| p.vertex_edges(*v)).copied().collect();
    edges.into_iter().filter(|&e| p.edge(e).vertices.iter().all(|v| support.contains(v))).collect()
}

/// The corners that lie farthest along `n`, ascending.
fn support(points: &[DVec3], corners: &[VertexId], n: DVec3, tolerance: f64) -> Vec<VertexId> {
    let top = corners.iter().map(|v| n.dot(points[v.index()])).fold(f64::NEG_INFINITY, f64::max);
    corners.iter().copied().filter(|v| n.dot(points[v.index()]) >= top - tolerance).collect()
}

/// The same, found from one of them: on a convex body they hang together by edges.
fn support_around(p: &Polyhedron, points: &[DVec3], from: VertexId, n: DVec3, tolerance: f64) -> Vec<VertexId> {
    let height = |v: VertexId| n.dot(points[v.index()]);
    let mut top = height(from);
    let mut found = vec![from];
    let mut next = 0;
    while next < found.len() {
        for &w in p.vertex_vertices(found[next]) {
            if height(w) >= top - tolerance && !found.contains(&w) {
                top = top.max(height(w));
                found.push(w);
            }
        }
        next += 1;
    }
    found.retain(|v| height(*v) >= top - tolerance);
    found.sort_unstable();
    found
}

/// Whether two arcs of the Gauss sphere cross or touch: each separates the other's ends, in the same hemisphere.
/// Without the third test antipodal arcs pass.
fn arcs_meet((c, d): (DVec3, DVec3), (e, f): (DVec3, DVec3)) -> bool {
    let (dc, fe) = (d.cross(c), f.cross(e));
    let (e_dc, f_dc, c_fe, d_fe) = (e.dot(dc), f.dot(dc), c.dot(fe), d.dot(fe));
    e_dc * f_dc <= ROUNDING && c_fe * d_fe <= ROUNDING && e_dc * d_fe >= -ROUNDING
}

type Corner = (DVec3, (VertexId, VertexId));

/// Convex hull of points in the plane across `n`, counter-clockwise seen from `n`'s tip, by gift wrapping: the points are
/// few, and unlike a sweep it does not depend on the order of points whose coordinates differ by rounding alone.
/// Points within `tolerance` of a side are left out, so that what remains are true corners.
fn planar_hull(points: &[Corner], n: DVec3, tolerance: f64) -> Vec<Corner> {
    let u = n.any_orthonormal_vector();
    let v = n.cross(u);
    let flat: Vec<DVec2> = points.iter().map(|p| DVec2::new(u.dot(p.0), v.dot(p.0))).collect();
    let right = flat.iter().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
    let rightmost = (0..flat.len()).filter(|&i| flat[i].x >= right - tolerance);
    let Some(start) = rightmost.max_by(|&i, &j| flat[i].y.total_cmp(&flat[j].y)) else { return Vec::new() };
    let mut hull = vec![start];
    while hull.len() <= points.len() {
        let here = flat[hull[hull.len() - 1]];
        let Some(next) = next_corner(&flat, here, tolerance) else { return Vec::new() };
        if flat[next].distance(flat[start]) <= tolerance {
            break;
        }
        hull.push(next);
    }
    if hull.len() < 3 {
        return Vec::new();
    }
    hull.into_iter().map(|i| points[i]).collect()
}

/// The point that has all others on its left, seen from `here`; of several in line, the farthest.
fn next_corner(points: &[DVec2], here: DVec2, tolerance: f64) -> Option<usize> {
    let mut best: Option<usize> = None;
    for (i, point) in points.iter().enumerate() {
        let to = *point - here;
        if to.length() <= tolerance {
            continue;
        }
        let better = best.is_none_or(|b| {
            let to_best = points[b] - here;
            // How far the point lies to the right of the best so far, or that of the point.
            let right = to.perp_dot(to_best) / to.length().max(to_best.length());
            right > tolerance || (right >= -tolerance && to.dot(to_best) > 0.0 && to.length() > to_best.length())
        });
        if better {
            best = Some(i);
        }
    }
    best
}
