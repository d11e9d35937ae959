#!/usr/bin/env bash
# What the system takes away, from every command that writes: descriptors, memory, threads, room in files and on
# disks, folders. Each run ends with 0, 1 or 2, says why it failed, and leaves complete files alone. Then sequences
# of a thousand frames, whose memory and descriptors stay as they were at the start.
#
# Usage: tests/faults.sh [MARBLES]    the program, by default target/release/marbles
#
# File systems are mounted where nobody else sees them; where that is not allowed, that part is skipped, and
# says so.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

marbles=$(realpath "${1:-${CARGO_TARGET_DIR:-target}/release/marbles}")
work=$(mktemp -d)
trap 'kill %% 2>/dev/null || true; wait; rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
cd "$work"

fail() {
    printf 'faults: %s\n' "$*"
    exit 1
}

cat >scene.ron <<'SCENE'
(
    image: (width: 60, height: 40),
    lens: Fov(40),
    camera: Orbit(target: (0, 0, 0), radius: 6),
    animation: Turntable(frames: 1000),
    ambient: 0.1,
    background: (0, 0, 1),
    lights: [Directional(toward: (-1, 1, -1), intensity: 0.9)],
    spheres: [(center: (0, 0, 0), radius: 1), (center: (1, 1, 0), radius: 0.5)],
    clouds: [(file: "table.csv", radius: 0.1)],
)
SCENE
awk -v OFS=, 'BEGIN { print "x,y,z"; for (i = 0; i < 3000; i++) print sin(i) * 2, cos(i * 1.3) * 2, sin(i * 1.7) * 2 }' \
    >table.csv
sed '/clouds:/d' scene.ron >ball.ron
sed -e 's/table.csv/series.####.csv/' -e 's/radius: 0.1)/radius: 0.1, frames: All)/' \
    -e '/animation:/d' -e 's/camera: .*/camera: Frame(),/' scene.ron >series.ron
mkdir steps whole
for step in 0001 0002; do cp table.csv "steps/series.$step.csv"; done
sed 's/series\.#/steps\/series.#/' series.ron >tmp.ron && mv tmp.ron series.ron

# What is put together and compared, from before anything is taken away.
half='render scene.ron --frames 1 --samples 1 --quiet --region'
"$marbles" $half 0,0,60,20 -o whole/a.exr
"$marbles" $half 0,20,60,20 -o whole/b.exr
"$marbles" render scene.ron --frames 1 --quiet -o whole/c.png

render='render scene.ron --samples 2 --threads 2 --quiet'
commands=(
    "$render --frames 1-4 -o out/#.png --sidecar"
    "$render --frames 1-3 -o out/#.exr --error-channel --float"
    "$render --frames 1-2 -o out/a.#.npy --error-channel --channels depth,id"
    "$render --frames 1-5 -o out/a.apng"
    "$render --frames 1 -o out/a.png --per-light --legend out/legend.svg"
    "merge out/a.exr whole/a.exr whole/b.exr"
    "compare whole/c.png whole/a.exr --quiet"
    "compare whole/c.png whole/c.png --quiet --diff out/d.exr"
    "spheres ball.ron --frames 1-2 -o out/spheres.csv"
    "dataset scene.ron -o out/data --layout diligent --quiet"
    "report ball.ron --runs 1 --seconds 0.1 --size 9x9 --quiet --csv out/r.csv --plot out/r.svg"
    "farm slurm scene.ron -o out/#.png --job out/job.sh"
    "check scene.ron"
    "render series.ron --samples 1 --quiet --frames 1-2 -o out/#.png"
    "new out/new.ron"
    "man -o out/man"
)

# Judges what a run has left: its exit code, what it said, and the files in `out`.
judge() {
    local code=$1 what=$2 file
    case $code in
        0) ;;
        1 | 2 | 3) [ -s errors ] || fail "$what: ends with $code and says nothing" ;;
        *) cat errors; fail "$what: ends with $code" ;;
    esac
    [ -d out ] || return 0
    while IFS= read -r file; do
        case $file in
            *.tmp | *.tmp[0-9]*) fail "$what: leaves $file" ;;
            *.png | *.apng | *.exr | *.npy)
                "$marbles" compare "$file" "$file" --quiet >said 2>&1 ||
                    grep -q 'channels, found\|channels R, G, B or Y' said ||
                    fail "$what: $file is not complete: $(cat said)"
                ;;
            *) [ -s "$file" ] || fail "$what: $file is empty" ;;
        esac
    done < <(find out -type f)
}

runs=0
failed=0
# Every command after `before`, which a shell of its own runs.
each() {
    local before=$1 command code
    for command in "${commands[@]}"; do
        rm -rf out
        code=0
        # Through a pipe, as the message itself may find no room in a file.
        bash -c "$before"'; exec "$@"' bash "$marbles" $command 2>&1 >/dev/null |
            cat >errors || code=${PIPESTATUS[0]}
        runs=$((runs + 1))
        [ "$code" -eq 0 ] || failed=$((failed + 1))
        judge "$code" "$before: marbles $command"
    done
}

part() {
    printf '%s: %d runs, of which %d failed as they should\n' "$1" "$runs" "$failed"
    [ "$failed" -gt 0 ] || fail "$1: nothing was taken away"
    runs=0
    failed=0
}

for count in $(seq 4 20); do each "ulimit -n $count"; done
part descriptors
for step in $(seq 1 20); do each "ulimit -v $((100000 + 10000 * step * step - 10000))"; done
part memory
for blocks in 0 1 2 4 16 64; do each "ulimit -f $blocks"; done
part 'sizes of files'

# Threads are counted for a user, and not for the system's own: here for a number that nobody has.
if [ "$(id -u)" -eq 0 ] && setpriv --reuid=64321 --regid=64321 --clear-groups true 2>/dev/null; then
    # Where that user may read and write.
    own=$marbles
    marbles=$work/marbles
    cp "$own" "$marbles"
    chmod -R a+rwX .
    user='setpriv --reuid=64321 --regid=64321 --clear-groups'
    for count in $(seq 2 10); do
        each "exec $user bash -c 'ulimit -u $count; exec \"\$@\"' bash \"\$@\""
    done
    marbles=$own
    part threads
else
    printf '== skipped: no other user can be had here\n'
fi

# ---- file systems

on_file_system() {
    local options=$1 command code
    for command in "${commands[@]}"; do
        rm -rf out
        mkdir out
        code=0
        # What was left is judged outside, where it is a copy.
        unshare --map-root-user --mount bash -c "
            mount -t tmpfs -o $options none out || exit 77
            \"\$@\" >results 2>errors; code=\$?
            mkdir copy; cp -r out/. copy/
            exit \$code" bash "$marbles" $command || code=$?
        [ "$code" -ne 77 ] || return 1
        rmdir out
        mv copy out
        runs=$((runs + 1))
        [ "$code" -eq 0 ] || failed=$((failed + 1))
        judge "$code" "mount -o $options: marbles $command"
    done
}

if unshare --map-root-user --mount mount -t tmpfs none whole 2>/dev/null; then
    for options in size=4k size=16k size=64k nr_inodes=2 nr_inodes=4 ro; do on_file_system "$options"; done
    part 'file systems that are full or read-only'
else
    printf '== skipped: nothing can be mounted here\n'
fi

# ---- a folder that goes away

for wait in 0.02 0.1 0.3; do
    rm -rf out
    code=0
    "$marbles" render scene.ron --samples 12 --quiet --frames 1-400 -o out/#.png >results 2>errors &
    pid=$!
    sleep "$wait"
    for turn in 1 2 3 4 5; do rm -rf out 2>/dev/null || true; done
    wait "$pid" || code=$?
    judge "$code" 'a folder that goes away'
done
printf 'a folder that goes away: complete files alone\n'

# ---- soak

# The largest memory in kB and the most descriptors of a process between two numbers of files in `out`.
soak() {
    local what=$1 first=0 last=0 first_files=0 last_files=0 count memory files pid code=0
    shift
    rm -rf out
    mkdir out
    "$marbles" "$@" --quiet --threads 2 >results 2>errors &
    pid=$!
    while kill -0 "$pid" 2>/dev/null; do
        count=$(find out -type f 2>/dev/null | wc -l || true)
        memory=$(awk '/VmRSS/ { print $2 }' "/proc/$pid/status" 2>/dev/null || true)
        files=$(find "/proc/$pid/fd" -type l 2>/dev/null | wc -l || true)
        if [ -n "$memory" ] && [ "$count" -gt 20 ] && [ "$count" -lt 400 ]; then
            [ "$memory" -le "$first" ] || first=$memory
            [ "$files" -le "$first_files" ] || first_files=$files
        elif [ -n "$memory" ] && [ "$count" -ge 600 ]; then
            [ "$memory" -le "$last" ] || last=$memory
            [ "$files" -le "$last_files" ] || last_files=$files
        fi
        sleep 0.05
    done
    wait "$pid" || code=$?
    [ "$code" -eq 0 ] || { cat errors; fail "$what: ends with $code"; }
    count=$(find out -type f | wc -l)
    [ "$count" -eq 1000 ] || fail "$what: $count files, expected 1000"
    printf '%s, 1000 frames: %d kB and %d descriptors at most before the 400th, %d and %d after the 600th\n' \
        "$what" "$first" "$first_files" "$last" "$last_files"
    [ "$first" -gt 0 ] && [ "$last" -gt 0 ] || fail "$what: too quick to be watched"
    [ "$last" -le $((first + first / 10 + 2000)) ] || fail "$what: memory grows"
    [ "$last_files" -le $((first_files + 2)) ] || fail "$what: descriptors grow"
}

soak PNG render scene.ron -o 'out/####.png' --samples 6
soak EXR render scene.ron -o 'out/####.exr' --samples 6
for step in $(seq -f %04g 1 1000); do cp table.csv "steps/series.$step.csv"; done
soak 'a series' render series.ron -o 'out/####.png' --samples 3
printf '\nall faults were told\n'
