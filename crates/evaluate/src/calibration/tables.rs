//! The tables of all drives of one kind.

use super::accepted::{PRECISION_DEG, percent};
use super::condition::{BySegment, Condition, Convergence, MethodResult, RadarResult};
use super::whole::FIGURE_RADAR;
use super::{DRIVING_TIMES_S, SEGMENTS_M};
use crate::table::table;

impl Condition {
    /// As Markdown.
    pub(super) fn tables(&self) -> String {
        let mut text = format!(
            "## {}: {} drives, {:.0} km, {:.1} h of driving, {:.0} % of detections moving (at most {:.0} %)\n\n",
            self.name,
            self.scenes,
            self.driven_km,
            self.driven_h,
            100.0 * self.moving_share[0],
            100.0 * self.moving_share[1],
        );
        let radars: Vec<String> = self
            .radars
            .iter()
            .map(|r| format!("radar {} ({:.2} deg)", r.sensor, r.true_deg))
            .collect();
        let radars: Vec<&str> = radars.iter().map(String::as_str).collect();
        text += &self.errors(&radars);
        for at in 0..SEGMENTS_M.len() {
            text += &self.trajectories(&radars, at);
        }
        text += &self.against_time(
            &format!(
                "Mean absolute error in deg and variance in deg^2 against driving time, radar {FIGURE_RADAR} (Figure 6; parts without an angle)."
            ),
            |c, i| {
                let (error, without) = (c.error_deg[i], or_none(c.without[i]));
                format!("{:.3}, {:.4}{without}", error.mean_absolute, error.variance)
            },
        );
        text += &self.against_time(
            "The share of these errors within one and two stated standard deviations.",
            |c, i| percent(c.within[i]),
        );
        text += &self.against_time(
            &format!(
                "Precision and recall: of the answers called converged the share within {PRECISION_DEG} deg, and their share of all parts."
            ),
            |c, i| c.accepted[i].cell(),
        );
        text + &self.scales()
    }

    fn errors(&self, radars: &[&str]) -> String {
        let cells = |method: &MethodResult| {
            let mut cells: Vec<String> = method
                .radars
                .iter()
                .map(|radar| {
                    let (error, without) = (radar.error_deg, or_none(radar.without));
                    format!("{:+.4}, {:.4}{without}", error.mean, error.variance)
                })
                .collect();
            cells.push(percent(method.within));
            let sum = |of: fn(&RadarResult) -> usize| method.radars.iter().map(of).sum::<usize>();
            cells.push(format!("{}, {}", sum(|r| r.converged), sum(|r| r.confidently_wrong)));
            cells
        };
        let mut heads = radars.to_vec();
        heads.extend(["within 1, 2 sigma", "converged, 3 sigma off"]);
        let rows: Vec<_> = self.methods.iter().map(|m| (m.name, cells(m))).collect();
        "Errors of the angle: mean in deg and variance in deg^2 (drives without an angle), the share of errors \
         within one and two stated standard deviations (Tables II and IV), and how many answers are called converged and \
         how many of these are more than three deviations off.\n\n"
            .to_owned()
            + &table("method", &heads, &rows)
    }

    fn trajectories(&self, radars: &[&str], at: usize) -> String {
        let length = SEGMENTS_M[at];
        let metres = |errors: &BySegment| errors[at].map_or("-".into(), |e| format!("{e:.3}"));
        let cell = |own: &BySegment, mean: &BySegment| format!("{}, {}", metres(own), metres(mean));
        let mut rows: Vec<(&str, Vec<String>)> = self
            .methods
            .iter()
            .map(|m| {
                (m.name, m.radars.iter().map(|r| cell(&r.rte_m, &r.rte_mean_angle_m)).collect())
            })
            .collect();
        let baseline = self.radars.iter().map(|r| metres(&r.rte_m)).collect();
        rows.push(("true angle", baseline));
        format!(
            "\nRelative trajectory error over {length} m, m, with each drive's own angle and with the true ones turned by the drives' mean \
             error; the radar's motion is the tracked one throughout (Table III).\n\n{}",
            table("angle from", radars, &rows)
        )
    }

    fn against_time(&self, what: &str, cell: impl Fn(&Convergence, usize) -> String) -> String {
        let times: Vec<String> = DRIVING_TIMES_S.iter().map(|time| format!("{time} s")).collect();
        let heads: Vec<&str> = times.iter().map(String::as_str).collect();
        let rows: Vec<_> = self
            .convergence
            .iter()
            .map(|c| (c.name, (0..heads.len()).map(|i| cell(c, i)).collect()))
            .collect();
        format!("\n{what}\n\n{}", table("method", &heads, &rows))
    }

    /// Nothing where no scale is known.
    fn scales(&self) -> String {
        let rows: Vec<_> = self
            .methods
            .iter()
            .filter_map(|m| {
                let [mean, sigma] = m.scale?;
                Some((m.name, vec![format!("{mean:+.4} +- {sigma:.4}"), percent(m.scale_within?)]))
            })
            .collect();
        if rows.is_empty() {
            return String::new();
        }
        "\nScale of the yaw rate: mean error and standard deviation, and the share within one and two stated standard \
         deviations.\n\n"
            .to_owned()
            + &table("method", &["error", "within 1, 2 sigma"], &rows)
    }

    /// Lines of comma-separated values after [`CSV_HEADS`].
    pub(super) fn csv(&self) -> String {
        let mut text = String::new();
        for method in &self.methods {
            for r in &method.radars {
                let (name, e) = (method.name, &r.error_deg);
                text += &format!(
                    "\"{}\",\"{name}\",{},{},{},{},{},{},{},{},{}",
                    self.name,
                    r.sensor,
                    e.count + r.without,
                    r.without,
                    e.mean,
                    e.variance,
                    e.mean_absolute,
                    e.largest,
                    r.converged,
                    r.confidently_wrong,
                );
                for errors in [r.rte_m, r.rte_mean_angle_m] {
                    text += &errors.map(|e| e.map_or(",".into(), |e| format!(",{e}"))).concat();
                }
                text.push('\n');
            }
        }
        text
    }
}

/// Heads of [`Condition::csv`].
pub(super) fn csv_heads() -> String {
    let errors = |of: &str| SEGMENTS_M.map(|length| format!(",rte_{length}{of}_m")).concat();
    format!(
        "condition,method,radar,drives,without,error_mean_deg,error_variance_deg2,error_mean_absolute_deg,\
         error_largest_deg,converged,confidently_wrong{}{}\n",
        errors(""),
        errors("_mean_angle"),
    )
}

/// A number that is mostly 0, behind another.
pub(super) fn or_none(count: usize) -> String {
    if count > 0 { format!(" ({count})") } else { String::new() }
}
