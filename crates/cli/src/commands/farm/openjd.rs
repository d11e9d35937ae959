//! A template of Open Job Description: one step, whose tasks are chunks of frames.
//!
//! Source: the specification `jobtemplate-2023-09` with its extension `TASK_CHUNKING`.

use serde::Serialize;

use super::Job;
use super::chunks::expression;
use crate::base::failure::Failure;

/// How long a renderer that is asked to end may take: it promises a second.
const NOTICE_SECONDS: u32 = 5;

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Template<'a> {
    specification_version: &'static str,
    extensions: [&'static str; 1],
    name: &'a str,
    description: &'static str,
    steps: [Step; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Step {
    name: &'static str,
    parameter_space: ParameterSpace,
    script: Script,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ParameterSpace {
    task_parameter_definitions: [TaskParameter; 1],
}

#[derive(Serialize)]
struct TaskParameter {
    name: &'static str,
    #[serde(rename = "type")]
    kind: &'static str,
    range: String,
    chunks: Chunks,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Chunks {
    default_task_count: u32,
    range_constraint: &'static str,
}

#[derive(Serialize)]
struct Script {
    actions: Actions,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Actions {
    on_run: Action,
}

#[derive(Serialize)]
struct Action {
    command: &'static str,
    args: Vec<String>,
    cancelation: Cancelation,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Cancelation {
    mode: &'static str,
    notify_period_in_seconds: u32,
}

/// The template, in JSON.
pub(super) fn template(job: &Job) -> Result<String, Failure> {
    let mut args = vec![
        "render".to_owned(),
        "--skip-existing".to_owned(),
        "--progress=openjd".to_owned(),
        "--frames={{Task.Param.Frame}}".to_owned(),
    ];
    for word in job.options.iter().chain([&job.output]) {
        args.push(literal(word)?.to_owned());
    }
    args.extend(["--".to_owned(), literal(&job.scene)?.to_owned()]);

    // Ranges may not overlap, and their order means nothing.
    let mut frames = job.frames.clone();
    frames.sort_unstable();
    let template = Template {
        specification_version: "jobtemplate-2023-09",
        extensions: ["TASK_CHUNKING"],
        name: &job.name,
        description: "Written by `marbles farm openjd`.",
        steps: [Step {
            name: "Render",
            parameter_space: ParameterSpace {
                task_parameter_definitions: [TaskParameter {
                    name: "Frame",
                    kind: "CHUNK[INT]",
                    range: expression(&frames),
                    chunks: Chunks {
                        default_task_count: job.chunk.get(),
                        range_constraint: "NONCONTIGUOUS",
                    },
                }],
            },
            script: Script {
                actions: Actions {
                    on_run: Action {
                        command: "marbles",
                        args,
                        cancelation: Cancelation {
                            mode: "NOTIFY_THEN_TERMINATE",
                            notify_period_in_seconds: NOTICE_SECONDS,
                        },
                    },
                },
            },
        }],
    };
    let text = serde_json::to_string_pretty(&template);
    text.map(|text| text + "\n")
        .map_err(|error| Failure::Work(format!("cannot write the template: {error}")))
}

/// A word that runners hand over as it is: they know no way to escape `{{`, and refuse control
/// characters.
fn literal(word: &str) -> Result<&str, Failure> {
    if word.contains("{{") || word.contains(char::is_control) {
        return Err(Failure::Usage(format!(
            "expected no `{{{{` and no control character in what a template of Open Job \
             Description passes on, found {word:?}"
        )));
    }
    Ok(word)
}
