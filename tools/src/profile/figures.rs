//! What `airlight profile` found: the rows of the JSON, which others read.

mod tables;

use super::arithmetic::Need;
use super::peers::Peer;
use super::rounds::{Spread, Times};
use super::streams::Stream;
use super::subject::{Subject, TOTAL};
use airlight::{Backend, Precision, Sampler, Strategy};
use serde::Serialize;

/// A row per time and ratio.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(crate) struct Figures(pub(crate) Vec<Row>);

/// The time of one sample, or a ratio of two such times. The names of the fields are the keys of the JSON.
#[derive(Debug, Serialize)]
pub(crate) struct Row {
    #[serde(flatten)]
    pub(crate) subject: Subject,
    pub(crate) ns_per_sample: Option<f64>,
    pub(crate) msamples_per_s: Option<f64>,
    /// The time of a whole call, of those of few rays.
    ns_per_call: Option<f64>,
    /// What the time is compared with; the ratio stands instead of the time.
    against: Option<&'static str>,
    pub(crate) ratio: Option<f64>,
    /// Between these lie the figures of all rounds, of which the median is reported.
    min: f64,
    max: f64,
    /// Of a limit of memory.
    gb_per_s: Option<f64>,
    /// The limit that the kernel is nearest to, and how near: the share of its time that the limit alone would take.
    pub(crate) bound_by: Option<&'static str>,
    pub(crate) share: Option<f64>,
    /// What 0.1 % of rays exceed in `|CDF(t) - u|`, of a peer; ours is in `airlight accuracy`.
    pub(crate) cdf_p999: Option<f64>,
}

impl Row {
    fn time(subject: Subject, times: &Times) -> Self {
        let Spread { median, min, max } = times.spread();
        let stream = Stream::ALL.into_iter().find(|stream| subject.limit == Some(stream.name()));
        Self {
            subject,
            ns_per_sample: Some(median),
            msamples_per_s: Some(1e3 / median),
            ns_per_call: subject.rays.filter(|_| subject.is_call()).map(|rays| median * rays as f64),
            against: None,
            ratio: None,
            min,
            max,
            gb_per_s: stream.map(|stream| stream.bytes_per_ray() as f64 / median),
            bound_by: None,
            share: None,
            cdf_p999: None,
        }
    }

    fn ratio(subject: Subject, against: &'static str, ratios: &Times) -> Self {
        let Spread { median, min, max } = ratios.spread();
        Self {
            subject,
            ns_per_sample: None,
            msamples_per_s: None,
            ns_per_call: None,
            against: Some(against),
            ratio: Some(median),
            min,
            max,
            gb_per_s: None,
            bound_by: None,
            share: None,
            cdf_p999: None,
        }
    }
}

impl Figures {
    /// From all that was measured, what the samplers need, and the errors of peers.
    pub(super) fn new(
        measured: &[(Subject, Times)],
        needs: &[(Sampler, Need)],
        peers_errors: &[(Subject, f64)],
    ) -> Self {
        let of = |wanted: Subject| measured.iter().find(|(subject, _)| *subject == wanted).map(|(_, times)| times);
        let mut rows = Vec::new();
        for (subject, times) in measured {
            match subject.stage {
                Some(TOTAL) if subject.strategy.is_some() => {
                    rows.extend(stages(subject, times, of));
                    rows.push(bounded(Row::time(*subject, times), needs, of));
                    rows.extend(ratios(subject, times, of));
                }
                // The ends of stages; how long each takes comes with the whole.
                Some("geometry" | "set-up" | "inversion") => {}
                _ => {
                    let of = |(of, _): &&(Subject, f64)| (of.peer, of.backend) == (subject.peer, subject.backend);
                    let cdf_p999 = peers_errors.iter().find(of).map(|(_, error)| *error);
                    rows.push(Row { cdf_p999, ..Row::time(*subject, times) });
                }
            }
        }
        Self(rows)
    }
}

/// What each stage of a kernel takes: as much as it takes longer to come to its end than to that of the one before.
fn stages<'a>(subject: &Subject, total: &Times, of: impl Fn(Subject) -> Option<&'a Times>) -> Vec<Row> {
    let up_to = |stage| of(Subject { stage: Some(stage), ..*subject });
    let [Some(geometry), Some(set_up), Some(inversion)] = ["geometry", "set-up", "inversion"].map(up_to) else {
        return Vec::new();
    };
    let stages = [
        ("geometry", geometry.clone()),
        ("set-up", set_up.minus(geometry)),
        ("inversion", inversion.minus(set_up)),
        ("output", total.minus(inversion)),
    ];
    stages.map(|(stage, times)| Row::time(Subject { stage: Some(stage), ..*subject }, &times)).into()
}

/// A kernel's time beside the limit that it is nearest to.
fn bounded<'a>(row: Row, needs: &[(Sampler, Need)], of: impl Fn(Subject) -> Option<&'a Times>) -> Row {
    let Subject { strategy, precision, backend, threads, rays, samples_per_ray, .. } = row.subject;
    let is_of = |of: &Sampler| {
        (Some(of.strategy().name()), Some(of.precision().name())) == (strategy, precision) && samples_per_ray == 1
    };
    let need = needs.iter().find(|(of, _)| is_of(of)).map(|(_, need)| need);
    let backend = Backend::available().find(|available| Some(available.name()) == backend);
    let (Some(need), Some(backend)) = (need, backend) else { return row };
    let one = |limit, backend, rays| {
        let subject = Subject { limit: Some(limit), backend, threads, rays, samples_per_ray: 1, ..Subject::default() };
        of(subject).map(|times| times.spread().median)
    };
    let arithmetic = |limit| one(limit, Some(backend.name()), None);
    let bounds = [
        ("fma", arithmetic("fma").map(|one| need.multiply_adds(backend, one))),
        ("division", arithmetic("division").map(|one| need.divisions(one))),
        ("stream", one("stream", None, rays)),
    ];
    let nearest =
        bounds.into_iter().filter_map(|(limit, bound)| Some((limit, bound?))).max_by(|a, b| a.1.total_cmp(&b.1));
    let share = nearest.zip(row.ns_per_sample).map(|((_, bound), time)| bound / time);
    Row { bound_by: nearest.map(|(limit, _)| limit), share, ..row }
}

/// A kernel's time against all that it is to be compared with.
fn ratios<'a>(subject: &Subject, ours: &Times, of: impl Fn(Subject) -> Option<&'a Times>) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut add = |subject, against, ratios: Option<Times>| {
        rows.extend(ratios.map(|ratios| Row::ratio(subject, against, &ratios)));
    };
    let equi_angular = Subject {
        strategy: Some(Strategy::EquiAngular.name()),
        rays: subject.rays.map(|rays| rays * subject.samples_per_ray),
        samples_per_ray: 1,
        ..*subject
    };
    add(*subject, "equi-angular", of(equi_angular).map(|theirs| ours.over(theirs)));
    if subject.samples_per_ray > 1 {
        return rows;
    }
    // The others are how many times as fast we are.
    let faster_than = |other| of(other).map(|theirs| theirs.over(ours));
    add(*subject, "portable", faster_than(Subject { backend: Some("portable"), ..*subject }));
    add(*subject, "one thread", faster_than(Subject { threads: 1, ..*subject }));
    if subject.precision == Some(Precision::Fast.name()) {
        let exact = Some(Precision::Exact.name());
        add(*subject, "exact", faster_than(Subject { precision: exact, ..*subject }));
    }
    let strategy = Strategy::ALL.iter().find(|strategy| Some(strategy.name()) == subject.strategy);
    if let Some(peer) = strategy.and_then(|&strategy| Peer::of(strategy)) {
        let peer = Some(peer.name());
        let theirs = Subject { peer, strategy: None, precision: None, ..*subject };
        add(Subject { peer, ..*subject }, "peer", faster_than(theirs));
    }
    if strategy == Some(&Strategy::TaylorPhase) {
        let taylor = Some(Strategy::TaylorTransmittance.name());
        add(*subject, "taylor-transmittance", faster_than(Subject { strategy: taylor, ..*subject }));
    }
    rows
}
