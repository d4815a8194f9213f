#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The tarball: what is in it, what it needs, and that it computes the paper's sweep in systems that have nothing else of it.
#   tarball_test.sh RPSUP SOURCES PRESET
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
sources=$2 preset=$3
source "$sources/tests/system/systems.sh"
need_mirror
make_packages --tarball
tar --list --verbose --file "$package" >contents
expect_equal "$(awk '$2 != "0/0" || $1 ~ /^.....w|^........w|s|t/' contents)" "" "files of others, or that others may write"
top=$(basename "$package" .tar.gz)
tar --extract --file "$package"
(cd "$top" && find . -type f) | sed 's#^\./##' | sort >files
programs=$(cd "$top" && echo bin/*)
cat >expected <<'FILES'
README.md
lib/systemd/system/rpsup.service
share/bash-completion/completions/rpsup
share/doc/rpsup/NOTICE
share/doc/rpsup/copyright
share/doc/rpsup/examples/config.ini
share/doc/rpsup/examples/paper.json
share/fish/vendor_completions.d/rpsup.fish
share/man/man1/rpsup.1.gz
share/rpsup/octave/rpsup.m
share/rpsup/python/rpsup/__init__.py
share/rpsup/python/rpsup/client.py
share/rpsup/python/rpsup/errors.py
share/rpsup/python/rpsup/program.py
share/rpsup/python/rpsup/progress.py
share/rpsup/python/rpsup/py.typed
share/rpsup/python/rpsup/study.py
share/rpsup/python/rpsup/sweep.py
share/rpsup/python/rpsup/table.py
share/rpsup/python/rpsup/transport.py
share/rpsup/python/rpsup/version.py
share/zsh/site-functions/_rpsup
FILES
diff expected <(grep -vE '^bin/|^share/doc/rpsup/licenses/' files) || fail "the files are others"
! grep -rE '@[A-Z]+@' "$top/README.md" || fail "the README was not filled in"
expect_text "$top/lib/systemd/system/rpsup.service" '^ExecStart=/opt/rpsup/bin/rpsup serve --config /etc/rpsup/config.ini$'

# Programs need the C library alone, of the version that the report and the README name, and that the README of the sources promises.
for program in $programs; do
  expect_equal "$(readelf --dynamic "$top/$program" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | grep -vxE 'lib[cm]\.so\.6|ld-linux-x86-64\.so\.2')" "" "libraries that $program needs"
  ! readelf --dynamic "$top/$program" | grep -E 'RPATH|RUNPATH' || fail "$program looks for libraries in a folder of the machine that built it"
done
least=$(cd "$top" && objdump --dynamic-syms $programs | grep -oE '\(GLIBC_[0-9.]+\)' | tr -d '()' | sed 's/GLIBC_//' | sort --version-sort --unique | tail -n 1)
expect_equal "$least" 2.34 "least version of glibc"
expect_text package.log "with glibc $least or newer"
expect_text "$top/README.md" "Needs glibc $least or newer"

# Every archive that is linked into them comes with its licence.
ninja -C "$sources/build/$preset" -t commands portable_files | grep -oE '/usr/lib/[^ ]*\.a' | sort -u >archives
[ "$(wc -l <archives)" -ge 8 ] || { cat archives; fail "the archives that are linked were not found"; }
xargs dpkg-query --search <archives | cut -d: -f1 | sort -u >owners
while read -r owner; do [ -s "$top/share/doc/rpsup/licenses/$owner" ] || fail "there is no licence of $owner"; done <owners

# The study, in this release and in one with a newer C library, moved to a folder of its own, by a user who owns nothing.
"$rpsup" sweep "$sources/script/paper.json" --db here.db --results here.json >log 2>&1
check_study here.json
codename=$(. /etc/os-release; echo "$VERSION_CODENAME")
for release in "$codename" trixie; do
  unpack_system "$release" "$release"
  mkdir -p "$release/srv/somewhere else"
  cp -r "$top" "$release/srv/somewhere else/"
  install --directory --owner=nobody "$release/srv/trial"
  inside=(chroot --userspec=nobody:nogroup "$release" env -i PATH=/usr/bin:/bin HOME=/nowhere)
  for program in $programs; do expect_equal "$("${inside[@]}" "/srv/somewhere else/$top/$program" --version)" "$("$(dirname "$rpsup")/$(basename "$program")" --version)" "version of $program"; done
  # The two commands of README.md, where the file is.
  cp "$package" "$release/srv/trial/"
  readme_block 'from the tarball' | sed 's# build/package/# #' >"$release/srv/trial/session.sh"
  "${inside[@]}" sh -euc 'cd /srv/trial; . ./session.sh' >log 2>&1 || { cat log; fail "the study cannot be computed in $release"; }
  expect_equal "$(wc -l <"$release/srv/trial/peaks.csv")" 41 "lines of the table"
  "${inside[@]}" "/srv/somewhere else/$top/bin/rpsup" sweep "/srv/somewhere else/$top/share/doc/rpsup/examples/paper.json" --db /srv/trial/study.db \
    --results /srv/trial/study.json >log 2>&1
  check_study "$release/srv/trial/study.json"
  # The same C library gives the same bytes, whether the other libraries are inside or not.
  if [ "$release" = "$codename" ]; then diff <(computed here.json) <(computed "$release/srv/trial/study.json") || fail "the study's results are others in $release"; fi
  # An exception passes, a name of a host is looked up, and the service serves and ends.
  expect_code 2 "${inside[@]}" "/srv/somewhere else/$top/bin/rpsup" simulate /nowhere.json
  expect_code 3 "${inside[@]}" "/srv/somewhere else/$top/bin/rpsup" status --url http://localhost:9
  : >ready
  "${inside[@]}" "/srv/somewhere else/$top/bin/rpsup" serve --db /srv/trial/study.db --port 0 >ready 2>log &
  service=$!
  for ((tenths = 0; tenths < 100; ++tenths)); do
    url=$(sed -n 's/^rpsup listens on //p' ready)
    [ -z "$url" ] || break
    sleep 0.1
  done
  expect_equal "$(status_of "${url:?the service does not start in $release}/readyz")" 200 "readiness in $release"
  expect_equal "$(get "$url/v1/sweeps" | jq -r '.items[0].state')" succeeded "state of the study"
  stop_service TERM
  expect_equal "$code" 0 "exit code of the service"
  echo "$release, $(chroot "$release" ldd --version | head -n 1): the study is computed, and served"
done
