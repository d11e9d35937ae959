//! A template of Open Job Description: one step, whose tasks are chunks of frames.
//!
//! Source: the specification `jobtemplate-2023-09` with its extension `TASK_CHUNKING`.

use super::chunks::expression;
use super::job::Job;
use crate::base::failure::Failure;
use crate::terminal::json::string;

/// The time that a renderer which is asked to end may take: it promises a second.
const NOTICE_SECONDS: u32 = 5;

/// The template, in JSON.
pub(super) fn template(job: &Job) -> Result<String, Failure> {
    const FIRST: [&str; 4] = [
        "render",
        "--skip-existing",
        "--progress=openjd",
        "--frames={{Task.Param.Frame}}",
    ];
    let mut args = FIRST.map(str::to_owned).to_vec();
    for word in job.options.iter().chain([&job.output]) {
        args.push(literal(word)?.to_owned());
    }
    args.extend(["--".to_owned(), literal(&job.scene)?.to_owned()]);
    let args: Vec<String> = args.iter().map(|word| string(word)).collect();

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
        name = string(&job.name),
        range = string(&expression(&frames)),
        chunk = job.chunk,
        args = args.join(",\n              "),
    ))
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
