//! The plot of convergence.

use crate::Result;
use crate::convergence::{Curve, Point, slope};
use plotters::prelude::*;
use std::path::Path;

/// Both axes logarithmic: thick with Sobol's points, thin with independent samples. Of several devices, which differ in
/// time alone, the first is shown.
pub fn write(path: &Path, curves: &[Curve]) -> Result<()> {
    let curves: Vec<&Curve> = curves.iter().filter(|curve| curve.device == curves[0].device).collect();
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let all = || curves.iter().flat_map(|curve| curve.sobol.iter().chain(&curve.independent));
    let lowest = all().map(|point| point.rmse).fold(f64::INFINITY, f64::min);
    let highest = all().map(|point| point.rmse).fold(0.0, f64::max);
    let most = all().map(|point| point.samples).max().unwrap_or(1);
    let area = SVGBackend::new(path, (720, 480)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(16)
        .x_label_area_size(36)
        .y_label_area_size(64)
        .build_cartesian_2d((1f64..f64::from(most)).log_scale(), (lowest * 0.8..highest * 1.2).log_scale())?;
    chart.configure_mesh().x_desc("camera samples a pixel").y_desc("RMSE").draw()?;
    for (number, Curve { scene, sobol, independent, .. }) in curves.iter().enumerate() {
        let colour = Palette99::pick(number).to_rgba();
        let name = scene.rsplit('/').next().unwrap_or(scene);
        for (points, width, kind) in [(sobol, 3, "Owen-scrambled Sobol"), (independent, 1, "independent")] {
            let line: Vec<_> = points.iter().map(|Point { samples, rmse, .. }| (f64::from(*samples), *rmse)).collect();
            chart
                .draw_series(LineSeries::new(line, colour.stroke_width(width)))?
                .label(format!("{name}: {kind}, N^{:.2}", slope(points)))
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], colour.stroke_width(width)));
        }
    }
    chart.configure_series_labels().position(SeriesLabelPosition::LowerLeft).border_style(BLACK).draw()?;
    area.present().map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(())
}
