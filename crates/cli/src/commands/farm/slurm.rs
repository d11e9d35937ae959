//! A script for `sbatch`: an array of tasks, one for each chunk of frames.

use super::chunks::expression;
use super::job::Job;
use crate::base::failure::Failure;

/// The largest number of tasks with Slurm's largest `MaxArraySize`.
const MOST_TASKS: usize = 4_000_000;

/// The part of a task that handles signals, which only the shell receives. It comes before the renderer starts in the
/// background.
///
/// At the time limit, Slurm sends SIGUSR1, and the task is queued again, but only as often as it has frames: after
/// that, a single frame takes longer than the limit. All other interruptions kill the task or send SIGTERM.
const SIGNALS: &str = r#"renderer=
ended=
again=
end() {
    ended=1
    signaled=1
    [ -z "$renderer" ] || kill -TERM "$renderer" 2>/dev/null
}
# Slurm also signals the renderer, which then ends within a second. A second signal would be of no use.
trap 'sleep 1; end' TERM INT
trap 'again=1; end' USR1
"#;

/// The part of a task that waits for the renderer: `wait` returns at every signal.
///
/// If some pixel is over the tolerance, a task ends with 3, like the renderer: rendering it again would change nothing.
const WAIT: &str = r#"renderer=$!
[ -z "$ended" ] || kill -TERM "$renderer"
signaled=1
while [ -n "$signaled" ]; do
    signaled=
    wait "$renderer"
    code=$?
done

# The renderer was interrupted, or the signal ended it before it could react.
if [ -n "$again" ] && { [ "$code" -eq 130 ] || [ "$code" -eq 143 ]; } &&
    [ "${SLURM_RESTART_COUNT:-0}" -lt "$chunk" ]; then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
fi
if [ "$code" -eq 3 ]; then
    echo "all is written, and some pixels are over the tolerance: $0 ends with 3" >&2
fi
exit "$code"
"#;

/// The script.
pub(super) fn script(job: &Job) -> Result<String, Failure> {
    let chunk = job.chunk.get() as usize;
    let tasks = job.tasks();
    if tasks > MOST_TASKS {
        return Err(Failure::Usage(format!(
            "--chunk {chunk}: expected at most {MOST_TASKS} tasks, Slurm's limit, found {tasks}"
        )));
    }
    let chunks = job.frames.chunks(chunk);
    let chunks: Vec<String> = chunks
        .map(|frames| format!("    {}\n", expression(frames)))
        .collect();
    let threads = match job.threads {
        true => "",
        false => r#" --threads="${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-1}}""#,
    };
    let progress = if job.progress {
        ""
    } else {
        " --progress=plain"
    };
    let options = job.options.iter().chain([&job.output]);
    let options: Vec<String> = options.map(|word| quoted(word)).collect::<Result<_, _>>()?;
    Ok(format!(
        r#"#!/bin/bash
#SBATCH --job-name={name}
#SBATCH --array=0-{last}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:USR1@60

# Written by `marbles farm slurm`. Set CPUs, memory and time with options of sbatch, such as
# --cpus-per-task=8 --time=60.

# The frames of each task.
chunk={chunk}
chunks=(
{chunks})

{SIGNALS}
marbles render --skip-existing{progress}{threads} \
    --frames="${{chunks[$SLURM_ARRAY_TASK_ID]}}" \
    {options} \
    -- {scene} &
{WAIT}"#,
        name = job.name,
        last = tasks.saturating_sub(1),
        chunks = chunks.concat(),
        options = options.join(" \\\n    "),
        scene = quoted(&job.scene)?,
    ))
}

/// A word, quoted for the shell.
fn quoted(word: &str) -> Result<String, Failure> {
    match shlex::try_quote(word) {
        Ok(quoted) => Ok(quoted.into_owned()),
        Err(error) => Err(Failure::Usage(format!("{word:?}: {error}"))),
    }
}
