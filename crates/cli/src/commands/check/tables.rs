//! The tables of a scene as JSON.

use marbles_scene::{ColorMeaning, ColumnContents, ScaleKind, Scene};
use serde_json::{Value, json};

use crate::base::failure::Failure;

/// The tables, their columns, and the meaning of the colors.
pub(super) fn json(scene: &Scene) -> Result<String, Failure> {
    let mut clouds = Vec::new();
    for (index, cloud) in scene.clouds().iter().enumerate() {
        let columns = scene.columns(index);
        let columns = columns.map_err(|error| Failure::Scene(Box::new(error)))?;
        let columns: Vec<Value> = columns
            .iter()
            .map(|column| {
                let mut object = match &column.contents {
                    ColumnContents::Numbers {
                        low,
                        high,
                        missing,
                        are_times,
                    } => {
                        let kind = if *are_times { "times" } else { "numbers" };
                        json!({"kind": kind, "low": low, "high": high, "missing": missing})
                    }
                    ColumnContents::Texts { count, examples } => {
                        json!({"kind": "texts", "count": count, "examples": examples})
                    }
                    ColumnContents::Other => json!({"kind": "other"}),
                };
                object["name"] = json!(column.name);
                object["unit"] = json!(column.unit);
                object
            })
            .collect();
        let colors = cloud.colors.as_ref().map(|colors| {
            let mut object = match &colors.meaning {
                ColorMeaning::Scale {
                    low, high, kind, ..
                } => {
                    let (scale, middle) = match kind {
                        ScaleKind::Linear => ("linear", None),
                        ScaleKind::Log => ("log", None),
                        ScaleKind::Diverging(middle) => ("diverging", Some(middle)),
                    };
                    json!({"low": low, "high": high, "scale": scale, "middle": middle})
                }
                ColorMeaning::Categories(categories) => {
                    let named = categories
                        .iter()
                        .map(|(name, color)| json!({"name": name, "color": color.to_array()}));
                    json!({"categories": named.collect::<Vec<_>>()})
                }
            };
            object["column"] = json!(colors.column);
            object["unit"] = json!(colors.unit);
            object
        });
        clouds.push(json!({
            "file": cloud.file.to_string_lossy(),
            "spheres": cloud.spheres.len(),
            "first_id": cloud.spheres.start,
            "rows": cloud.rows,
            "kept": cloud.kept,
            "cell": cloud.cell.as_ref().map(|cell| json!({
                "edges": cell.edges.map(|edge| edge.to_array()),
                "origin": cell.origin.to_array(),
                "lengths": cell.lengths,
                "angles": cell.angles,
                "repeat": cell.repeat,
            })),
            "right_handed": cloud.is_right_handed,
            "steps": cloud.steps,
            "columns": columns,
            "colors": colors,
        }));
    }
    let text = serde_json::to_string_pretty(&clouds);
    let text = text.map_err(|error| Failure::Work(error.to_string()))?;
    Ok(text.replace('\n', "\n  "))
}
