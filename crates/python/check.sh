#!/usr/bin/env bash
# Builds the wheel, installs it in an environment of its own, and tests it: pytest with the examples and the documents,
# mypy on all that is typed, and the stubs against the module. Says so where there is no Python 3.10, or no package index.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=${CARGO_TARGET_DIR:-target}/python
environment=$folder/environment

skip() {
    printf 'skipped: %s\n' "$1"
    exit 0
}

python3 -c 'import sys, venv; sys.exit(sys.version_info < (3, 10))' 2>/dev/null ||
    skip 'there is no Python of at least version 3.10 with venv'
[ -x "$environment/bin/python" ] || python3 -m venv "$environment" || skip 'no environment can be made'
python=$PWD/$environment/bin/python
case $environment in /*) python=$environment/bin/python ;; esac
"$python" -m pip install --quiet --disable-pip-version-check 'maturin>=1.9,<2' 'numpy>=1.24' 'mypy>=1.10' 'pytest>=8' ||
    skip 'the packages cannot be had'

cargo clippy --quiet --locked --package marbles-python --features module -- --deny warnings
# The profile of the tests: marbles-core is there already.
rm -rf "$folder/wheels"
"$python" -m maturin build --quiet --locked --profile dev --interpreter "$python" \
    --manifest-path crates/python/Cargo.toml --out "$folder/wheels"
"$python" -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps "$folder"/wheels/marbles-*.whl

cd crates/python
"$python" -m pytest --quiet -p no:cacheprovider
"$python" -m mypy --strict --cache-dir "$environment/mypy" python/marbles tests examples
"$python" -m mypy.stubtest marbles._native --ignore-missing-stub --mypy-config-file pyproject.toml
