//! The tables of all drives of one kind.

use crate::accepted::{PRECISION_DEG, percent};
use crate::candidates::{DRIVING_TIMES_S, SEGMENTS_M};
use crate::condition::{BySegment, Condition, Convergence, MethodResult, RadarResult};
use crate::table::{Best, Cell, Table};
use crate::whole::FIGURE_RADAR;

impl Condition {
    /// Its tables; the title of the first one begins with a heading.
    pub fn tables(&self) -> Vec<Table> {
        let heading = format!(
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
        let mut errors = self.errors(&radars);
        errors.title.insert_str(0, &heading);
        let mut tables = vec![errors];
        tables.extend((0..SEGMENTS_M.len()).map(|at| self.trajectories(&radars, at)));
        tables.push(self.against_time(
            format!(
                "Mean absolute error in deg and variance in deg^2 against driving time, radar {FIGURE_RADAR} (Figure 6; parts without an angle)."
            ),
            |c, i| {
                let (error, without) = (c.error_deg[i], or_none(c.without[i]));
                format!("{:.3}, {:.4}{without}", error.mean_absolute, error.variance)
            },
        ));
        tables.push(self.against_time(
            "The share of these errors within one and two stated standard deviations.".into(),
            |c, i| percent(c.within[i]),
        ));
        tables.push(self.against_time(
            format!(
                "Precision and recall: of the answers called converged the share within {PRECISION_DEG} deg, and their share of all parts."
            ),
            |c, i| c.accepted[i].cell(),
        ));
        tables.extend(self.scales());
        tables
    }

    fn errors(&self, radars: &[String]) -> Table {
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
            cells.into_iter().map(Cell::text).collect()
        };
        let further = ["within 1, 2 sigma", "converged, 3 sigma off"].map(String::from);
        Table::new(
            "Errors of the angle: mean in deg and variance in deg^2 (drives without an angle), the share of errors \
             within one and two stated standard deviations (Tables II and IV), and how many answers are called converged and \
             how many of these are more than three deviations off.",
            Best::None,
            "method",
            radars.iter().chain(&further),
            self.methods.iter().map(|m| (m.name, cells(m))),
        )
    }

    fn trajectories(&self, radars: &[String], at: usize) -> Table {
        let length = SEGMENTS_M[at];
        let metres = |errors: &BySegment| errors[at].map_or("-".into(), |e| format!("{e:.3}"));
        let cell = |own: &BySegment, mean: &BySegment| {
            Cell::text(format!("{}, {}", metres(own), metres(mean)))
        };
        let rows = self.methods.iter().map(|m| {
            (m.name, m.radars.iter().map(|r| cell(&r.rte_m, &r.rte_mean_angle_m)).collect())
        });
        let baseline = self.radars.iter().map(|r| Cell::text(metres(&r.rte_m))).collect();
        Table::new(
            format!(
                "Relative trajectory error over {length} m, m, with each drive's own angle and with the true ones turned by the drives' mean \
                 error; the radar's motion is the tracked one throughout (Table III)."
            ),
            Best::None,
            "angle from",
            radars,
            rows.chain([("true angle", baseline)]),
        )
    }

    fn against_time(&self, title: String, cell: impl Fn(&Convergence, usize) -> String) -> Table {
        let row = |c: &Convergence| -> Vec<Cell> {
            (0..DRIVING_TIMES_S.len()).map(|i| Cell::text(cell(c, i))).collect()
        };
        let heads = DRIVING_TIMES_S.map(|time| format!("{time} s"));
        let rows = self.convergence.iter().map(|c| (c.name, row(c)));
        Table::new(title, Best::None, "method", heads, rows)
    }

    /// Nothing where no scale is known.
    fn scales(&self) -> Option<Table> {
        let rows: Vec<_> = self
            .methods
            .iter()
            .filter_map(|m| {
                let [mean, sigma] = m.scale?;
                let cells = [format!("{mean:+.4} +- {sigma:.4}"), percent(m.scale_within?)];
                Some((m.name, cells.map(Cell::text).to_vec()))
            })
            .collect();
        let title = "Scale of the yaw rate: mean error and standard deviation, and the share within one and two stated standard \
                     deviations.";
        let heads = ["error", "within 1, 2 sigma"];
        (!rows.is_empty()).then(|| Table::new(title, Best::None, "method", heads, rows))
    }

    /// Lines of comma-separated values after [`csv_heads`].
    pub fn csv(&self) -> String {
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
pub fn csv_heads() -> String {
    let errors = |of: &str| SEGMENTS_M.map(|length| format!(",rte_{length}{of}_m")).concat();
    format!(
        "condition,method,radar,drives,without,error_mean_deg,error_variance_deg2,error_mean_absolute_deg,\
         error_largest_deg,converged,confidently_wrong{}{}\n",
        errors(""),
        errors("_mean_angle"),
    )
}

/// A number that is mostly 0, behind another.
pub(crate) fn or_none(count: usize) -> String {
    if count > 0 { format!(" ({count})") } else { String::new() }
}
