#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The wheel and the source archive: what is in them, that they are the same bytes twice, and that they install
# and work without a network.
#   wheel_test.sh RPSUP SOURCES PRESET
source "$(dirname "${BASH_SOURCE[0]}")/../system/helpers.sh"
sources=$2 preset=$3
for module in setuptools wheel venv ensurepip pandas; do
  /usr/bin/python3 -c "import $module" 2>/dev/null ||
    { echo "skipped: Python's $module comes with script/setup all"; exit 77; }
done
# As a machine without a network has it, for what follows, too.
export http_proxy=http://127.0.0.1:9 https_proxy=http://127.0.0.1:9
export PIP_NO_INDEX=1 PIP_DISABLE_PIP_VERSION_CHECK=1
built=$sources/build/package
[ "$preset" = release ] || built=$sources/build/$preset/package
for round in first second; do
  "$sources/script/package" --python "$preset" >package.log 2>&1 ||
    { cat package.log; fail "script/package --python failed"; }
  mkdir "$round"
  cp "$built"/rpsup-*.whl "$built"/rpsup-*-python.tar.gz "$round/"
done
diff -r 'first' second || fail "two packages of the same sources differ"
wheel=$(echo "$PWD"/first/rpsup-*.whl) archive=$(echo "$PWD"/first/rpsup-*-python.tar.gz)
/usr/bin/python3 -m zipfile --list "$wheel" >contents
for file in rpsup/client.py rpsup/py.typed LICENSE; do
  grep -qF "$file" contents || { cat contents; fail "the wheel has no $file"; }
done
! tar --list --gzip --file "$archive" | grep -E 'pycache|ipynb' || fail "the archive has too much"

# The version is that of the sources, which a program that was built before the last commit need not have.
version=$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\(.*\)")$/\1/p' "$sources/build/$preset/CPackConfig.cmake")
expect_equal "$(basename "$wheel")" "rpsup-$version-py3-none-any.whl" "name of the wheel"

# Three lines to a table, with the program on the PATH and the wheel in an environment of its own.
cat >study.py <<'END'
import rpsup
with rpsup.start() as client:
    table = client.submit(open("study.json").read()).wait().results()
print(rpsup.__version__, rpsup.__file__, len(table), table.attrs["units"]["peak_slider_acceleration_m_s2"])
END
# The paper's study, of which each job is short here, without replicates.
short='del(.replicates) | .parameters += {"duration_s": 0.1, "run_up_s": 0.05}'
jq "$short" "$sources/script/paper.json" >study.json
jobs=$("$rpsup" sweep study.json --db count.db --results count.json 2>/dev/null && jq length count.json)
for source in "$wheel" "$archive"; do
  rm -rf environment
  /usr/bin/python3 -m venv --system-site-packages environment
  environment/bin/pip install --quiet --no-index --no-build-isolation "$source" 2>pip.log ||
    { cat pip.log; fail "$source does not install"; }
  PATH=$(dirname "$rpsup"):$PATH expect_code 0 environment/bin/python study.py
  expect_equal "$(sed "s#$(realpath environment)/lib/python3.[0-9]*/##" out)" \
    "$version site-packages/rpsup/__init__.py $jobs m/s²" "the study"
done
echo "wheel and source archive of version $version work"
