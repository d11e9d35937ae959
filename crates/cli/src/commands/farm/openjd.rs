//! A template of Open Job Description: one step, whose tasks are chunks of frames.
//!
//! Source: the specification `jobtemplate-2023-09` with its extension `TASK_CHUNKING`.

use super::chunks::expression;
use super::job::Job;
use serde_json::Value;

use crate::base::failure::Failure;

/// The time that the renderer may take to stop after a signal. It promises one second.
const NOTICE_SECONDS: u32 = 5;

/// The template, in JSON.
pub(super) fn template(job: &Job) -> Result<String, Failure> {
    // Ranges may not overlap, and their order means nothing.
    let mut frames = job.frames.clone();
    frames.sort_unstable();
    Ok(format!(
        r#"{{
  "specificationVersion": "jobtemplate-2023-09",
  "extensions": [
    "TASK_CHUNKING"
  ],
  "name": {name},
  "description": "Written by `marbles farm openjd`.",
  "steps": [
    {{
      "name": "Render",
      "parameterSpace": {{
        "taskParameterDefinitions": [
          {{
            "name": "Frame",
            "type": "CHUNK[INT]",
            "range": {range},
            "chunks": {{
              "defaultTaskCount": {chunk},
              "rangeConstraint": "NONCONTIGUOUS"
            }}
          }}
        ]
      }},
      "script": {{
        "actions": {{
          "onRun": {{
            "command": "marbles",
            "args": [
              {args}
            ],
            "cancelation": {{
              "mode": "NOTIFY_THEN_TERMINATE",
              "notifyPeriodInSeconds": {NOTICE_SECONDS}
            }}
          }}
        }}
      }}
    }}
  ]
}}
"#,
        name = Value::from(&*job.name),
        range = Value::from(expression(&frames)),
        chunk = job.chunk,
        args = arguments(job)?.join(",\n              "),
    ))
}

/// The command line of a task, each word in JSON.
fn arguments(job: &Job) -> Result<Vec<String>, Failure> {
    const FIRST: [&str; 4] = [
        "render",
        "--skip-existing",
        "--progress=openjd",
        "--frames={{Task.Param.Frame}}",
    ];
    let options = job.options.iter().chain([&job.output]);
    let mut words = FIRST.to_vec();
    for word in options {
        words.push(literal(word)?);
    }
    words.extend(["--", literal(&job.scene)?]);
    Ok(words
        .into_iter()
        .map(|word| Value::from(word).to_string())
        .collect())
}

/// A word that runners pass on unchanged: they have no way to escape `{{`, and refuse control characters.
fn literal(word: &str) -> Result<&str, Failure> {
    if word.contains("{{") || word.contains(char::is_control) {
        return Err(Failure::Usage(format!(
            "expected no `{{{{` and no control character in the arguments of a template of Open Job Description, \
             found {word:?}"
        )));
    }
    Ok(word)
}
