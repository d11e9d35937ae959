#!/usr/bin/env bash
# Renders on real farms, as far as this machine has them: `openjd run`, and a Slurm of four nodes on
# one host, of which one is killed while it renders. What they render has to be identical to what
# `marbles render` does alone, byte by byte.
#
# Usage: tests/farm.sh [MARBLES]    the program, by default target/release/marbles
#
# What lacks is installed where that can be done, by pip into a folder of its own, by apt for root; else
# that part is skipped, and says so. Everything listens on 127.0.0.1 alone, lives in a temporary folder and
# ends with the script.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

marbles=$(realpath "${1:-${CARGO_TARGET_DIR:-target}/release/marbles}")
scene=$PWD/scenes/turntable.ron
work=$(mktemp -d)
daemons=()
mkdir "$work/bin"
ln -s "$marbles" "$work/bin/marbles"
export PATH="$work/bin:$PATH:/usr/sbin:/sbin"

cleanup() {
    local code=$?
    trap - EXIT
    if [ -n "${SLURM_CONF:-}" ]; then
        # Tasks outlive the daemons of their node.
        timeout 10 scancel --user="$(id -un)" || true
        within 10 none_is_left || true
        local node
        for node in n1 n2 n3 n4; do
            end_task_on "$node" || true
        done
    fi
    for pid in "${daemons[@]}"; do
        kill -TERM "$pid" 2>/dev/null || true
    done
    for pid in "${daemons[@]}"; do
        timeout 5 tail --pid="$pid" -f /dev/null || kill -KILL "$pid" 2>/dev/null || true
    done
    if [ "$code" -ne 0 ]; then
        printf '\ntests/farm.sh failed; last lines of the logs:\n'
        tail -n 10 "$work"/*.log "$work"/log/* 2>/dev/null || true
    fi
    rm -rf "$work"
    exit "$code"
}
trap cleanup EXIT
trap 'exit 1' INT TERM

fail() {
    printf 'farm: %s\n' "$*"
    exit 1
}

skip() {
    printf '\n== skipped: %s\n' "$*"
}

# Whether the condition becomes true within so many seconds.
within() {
    local end=$((SECONDS + $1))
    shift
    until "$@"; do
        [ "$SECONDS" -lt "$end" ] || return 1
        sleep 0.2
    done
}

same() {
    diff -r "$work/local/$1" "$2" || fail "the pictures differ from those of marbles render"
}

# ---- alone

# Slow enough that a node can be killed in the middle.
options=(--size 90x90 --samples 24 --alpha)
render_alone() {
    marbles render "$scene" --quiet "${options[@]}" --frames "1-$1" -o "$work/local/$1/a b ####.png"
}

# ---- Open Job Description

find_openjd() {
    command -v openjd >/dev/null && return
    local venv=${CARGO_TARGET_DIR:-target}/farm-venv
    if [ ! -x "$venv/bin/openjd" ]; then
        python3 -m venv "$venv" &&
            timeout 150 "$venv/bin/pip" --quiet --disable-pip-version-check install openjd-cli
    fi >"$work/pip.log" 2>&1 || return 1
    PATH=$PATH:$(realpath "$venv/bin")
}

openjd_job() {
    printf '\n== %s\n' "openjd $(openjd --version 2>&1 | head -n 1)"
    local job=$work/job.template.json
    marbles farm openjd "$scene" --frames 1-19:2,2-20:2 --chunk 6 "${options[@]}" \
        -o "$work/openjd/a b ####.png" --job "$job"
    timeout 60 openjd check "$job"
    timeout 60 openjd summary "$job"
    timeout 120 openjd run "$job" --verbose >"$work/openjd.log" 2>&1 || fail "openjd run failed"
    same 20 "$work/openjd"
    # The runner has read what the renderer said, and handed over four chunks.
    local chunks
    chunks=$(grep -c 'Frame(CHUNK\[INT\]) = ' "$work/openjd.log" || true)
    [ "$chunks" -eq 4 ] || fail "expected 4 chunks, found $chunks"
    grep -q 'openjd_progress: 100' "$work/openjd.log" || fail "there is no progress"
    grep -q 'openjd_status: frame ' "$work/openjd.log" || fail "there is no status"

    # Any list of frames means the same to both.
    "$(dirname "$(realpath "$(command -v openjd)")")/python" tests/farm_ranges.py || fail "lists of frames differ"

    # Once more, all frames are there.
    timeout 120 openjd run "$job" >"$work/openjd.log" 2>&1 || fail "openjd run failed again"
    [ "$(grep -c ': skipped' "$work/openjd.log")" -eq 20 ] || fail "frames were rendered twice"
    same 20 "$work/openjd"

    # What fails says why.
    if timeout 120 openjd run "$job" --verbose -tp Frame=1x >"$work/openjd.log" 2>&1; then
        fail "openjd run is content with frames that there are not"
    fi
}

# ---- Slurm

find_slurm() {
    command -v slurmctld slurmd sbatch munged >/dev/null && return
    [ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null || return 1
    {
        timeout 120 apt-get update &&
            DEBIAN_FRONTEND=noninteractive timeout 300 \
                apt-get install -y --no-install-recommends slurm-wlm munge
    } >"$work/apt.log" 2>&1 || return 1
    command -v slurmctld slurmd sbatch munged >/dev/null
}

start() {
    "$@" &
    daemons+=($!)
    disown
}

# The first of five ports that nobody listens at.
free_ports() {
    local first port
    while :; do
        first=$((RANDOM % 20000 + 10000))
        for port in $(seq "$first" $((first + 4))); do
            ! (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || continue 2
        done
        printf '%s\n' "$first"
        return
    done
}

start_slurm() {
    local host port
    host=$(hostname -s)
    port=$(free_ports)
    mkdir -m 700 "$work/munge" "$work/state"
    mkdir "$work/spool" "$work/log"
    (umask 077 && head -c 1024 /dev/urandom >"$work/munge/key")
    start munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" \
        --pid-file="$work/munge/pid" --log-file="$work/log/munged" --seed-file="$work/munge/seed" \
        2>"$work/munged.log"
    within 10 test -S "$work/munge/socket" || fail "munged does not start"

    cat >"$work/slurm.conf" <<END
ClusterName=farm
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket,cred_expire=5
CredType=cred/munge
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmctldPort=$port
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool/%n
SlurmctldPidFile=$work/state/slurmctld.pid
SlurmdPidFile=$work/spool/%n.pid
SlurmctldLogFile=$work/log/slurmctld
SlurmdLogFile=$work/log/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SlurmdTimeout=6
KillWait=5
MessageTimeout=5
ReturnToService=2
NodeName=n[1-4] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 4))] CPUs=1 State=UNKNOWN
PartitionName=farm Nodes=ALL Default=YES MaxTime=10 State=UP
END
    chmod 644 "$work/slurm.conf"
    printf 'CgroupPlugin=cgroup/v1\n' >"$work/cgroup.conf"
    export SLURM_CONF=$work/slurm.conf
    start slurmctld -D -i 2>"$work/slurmctld.log"
    local node
    for node in n1 n2 n3 n4; do
        start slurmd -D -N "$node" 2>"$work/$node.log"
    done
    within 30 four_are_idle || fail "the nodes do not start"
}

four_are_idle() {
    [ "$(timeout 5 sinfo -h -N -t idle -o %N 2>/dev/null | wc -l)" -eq 4 ]
}

# Prints what the environment of a process says about a variable.
variable() {
    { tr '\0' '\n' <"/proc/$1/environ" | sed -n "s/^$2=//p"; } 2>/dev/null
}

# The process of the script that a node of ours runs; fails if there is none.
script_on() {
    local process
    for process in $(pgrep -f slurm_script); do
        if [ "$(variable "$process" SLURMD_NODENAME)" = "$1" ] &&
            [ "$(variable "$process" SLURM_CONF)" = "$SLURM_CONF" ]; then
            printf '%s\n' "$process"
            return
        fi
    done
    return 1
}

# Ends what runs on a node of ours at once: the script, the renderer, and the shepherd of both.
end_task_on() {
    local shell step
    shell=$(script_on "$1") || return 1
    step=$(ps -o ppid= -p "$shell" | tr -d ' ')
    [ "$(ps -o comm= -p "$step")" = slurmstepd ] || return 1
    # shellcheck disable=SC2046 # one word for each process
    kill -KILL "$step" "$shell" $(ps -o pid= --ppid "$shell") || true
}

# The node is gone, with all that runs on it; but not before its task has written a frame, and only
# while others are missing. Leaves the task's number in `killed`.
kill_node() {
    local shell frames
    shell=$(script_on "$1") || return 1
    killed=$(variable "$shell" SLURM_ARRAY_TASK_ID)
    frames=$(grep -c ': error <= ' "$work/log/task-$killed" 2>/dev/null) || return 1
    [ "$frames" -lt 4 ] || return 1
    kill -KILL "$(cat "$work/spool/$1.pid")"
    end_task_on "$1"
}

none_is_left() {
    [ -z "$(timeout 5 squeue -h 2>&1)" ]
}

slurm_job() {
    printf '\n== %s\n' "$(slurmctld -V)"
    start_slurm
    local job=$work/job.sh id
    marbles farm slurm "$scene" --frames 1-40 --chunk 5 "${options[@]}" \
        -o "$work/slurm/a b ####.png" --job "$job"
    timeout 10 sbatch --chdir="$work" --output="$work/log/task-%a" "$job"
    local killed
    within 60 kill_node n2 || fail "there is nothing to kill on n2"
    printf 'killed n2 with task %s\n' "$killed"
    within 120 none_is_left || { squeue; sinfo; fail "the job does not end"; }

    local jobs
    jobs=$(timeout 10 scontrol -o show job)
    printf '%s\n' "$jobs" | sed -E 's/.*ArrayTaskId=([0-9]+).*JobState=([A-Z]+).*Restarts=([0-9]+).*NodeList=(\(null\)|[a-z0-9]+).*/task \1: \2, \3 restarts, at last on \4/' | sort
    [ "$(grep -c 'JobState=COMPLETED' <<<"$jobs")" -eq 8 ] || fail "some task is not completed"
    grep -q "ArrayTaskId=$killed .*Restarts=1" <<<"$jobs" || fail "task $killed was not requeued"
    grep -q ': skipped' "$work/log/task-$killed" || fail "task $killed did not resume"
    same 40 "$work/slurm"

    # One that is canceled ends soon, and leaves nothing that is not complete.
    marbles farm slurm "$scene" --frames 1-40 --chunk 40 "${options[@]}" \
        -o "$work/canceled/####.png" --job "$job"
    id=$(timeout 10 sbatch --parsable --chdir="$work" --output="$work/log/canceled" "$job")
    within 30 grep -qs ': error <= ' "$work/log/canceled" || fail "nothing is rendered"
    timeout 10 scancel "$id"
    within 30 none_is_left || fail "the job is not canceled"
    grep -q 'marbles: interrupted: ' "$work/log/canceled" || fail "the renderer was not interrupted"
    [ -z "$(find "$work/canceled" ! -name '*.png' -type f)" ] || fail "a temporary file was left"
}

# One frame in parts, and a job that puts them together, as docs/farm.md has it.
slurm_parts() {
    local id
    cat >"$work/parts.sh" <<END
#!/bin/bash
#SBATCH --array=0-2
#SBATCH --requeue
marbles render "$scene" ${options[*]} --frames 7 --skip-existing -o "part-\$SLURM_ARRAY_TASK_ID.exr" \\
    --region "0,\$((SLURM_ARRAY_TASK_ID * 30)),90,30"
END
    id=$(timeout 10 sbatch --parsable --chdir="$work" --output="$work/log/part-%a" "$work/parts.sh")
    timeout 10 sbatch --dependency="afterok:$id" --chdir="$work" --output="$work/log/merge" \
        --wrap 'marbles merge poster.exr part-?.exr'
    within 60 none_is_left || { squeue; fail "the parts are not put together"; }
    marbles render "$scene" --quiet "${options[@]}" --frames 7 -o "$work/whole.exr"
    cmp "$work/whole.exr" "$work/poster.exr" || fail "the parts are not the whole"
    printf 'a frame in three parts is the whole\n'
}

# ---- all

render_alone 20
if find_openjd; then
    openjd_job
else
    skip "openjd is not installed, and pip cannot install it"
fi
if find_slurm; then
    render_alone 40
    slurm_job
    slurm_parts
else
    skip "Slurm is not installed, and apt cannot install it"
fi
