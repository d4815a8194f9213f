#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The Debian package: what is in it, who owns it, what it depends on, and that the unit is as closed as it says.
#   package_test.sh RPSUP SOURCES PRESET
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
sources=$2 preset=$3
source "$sources/tests/system/systems.sh"
make_packages --deb
[ -f "$package" ] || { cat package.log; fail "there is no package"; }

# The fields for dpkg.
field() { dpkg-deb --field "$package" "$1"; }
expect_equal "$(field Package) $(field Section)" "rpsup science" "name and section"
expect_equal "$(field Version)" "$("$rpsup" --version | sed -E 's/^rpsup //; s/[+.]g[0-9a-f]{12}(\.dirty)?$//')" "version"
expect_equal "$(field Architecture)" "$(dpkg --print-architecture)" "architecture"
for library in libc6 libstdc++6 libsqlite3-0 libzstd1 libcpp-httplib; do
  [[ "$(field Depends)" == *$library* ]] || fail "the package does not depend on $library: $(field Depends)"
done
! [[ "$(field Depends)" =~ -dev|cmake ]] || fail "the package depends on what builds it: $(field Depends)"

# Its files, all of them of root, writable for nobody else.
dpkg-deb --contents "$package" | awk '{ print $1, $2, $6 }' >contents
sed -n 's/^-[^ ]* [^ ]* \.//p' contents | sort >files
cat >expected <<'FILES'
/etc/rpsup/config.ini
/usr/bin/rpsup
/usr/bin/rpsup-validate
/usr/lib/python3/dist-packages/rpsup/__init__.py
/usr/lib/python3/dist-packages/rpsup/client.py
/usr/lib/python3/dist-packages/rpsup/errors.py
/usr/lib/python3/dist-packages/rpsup/program.py
/usr/lib/python3/dist-packages/rpsup/progress.py
/usr/lib/python3/dist-packages/rpsup/py.typed
/usr/lib/python3/dist-packages/rpsup/study.py
/usr/lib/python3/dist-packages/rpsup/sweep.py
/usr/lib/python3/dist-packages/rpsup/table.py
/usr/lib/python3/dist-packages/rpsup/transport.py
/usr/lib/python3/dist-packages/rpsup/version.py
/usr/lib/systemd/system/rpsup.service
/usr/share/bash-completion/completions/rpsup
/usr/share/doc/rpsup/NOTICE
/usr/share/doc/rpsup/copyright
/usr/share/doc/rpsup/examples/paper.json
/usr/share/fish/vendor_completions.d/rpsup.fish
/usr/share/man/man1/rpsup.1.gz
/usr/share/rpsup/octave/rpsup.m
/usr/share/zsh/vendor-completions/_rpsup
FILES
diff expected files || fail "the files are others"
expect_equal "$(awk '$2 != "root/root" || $1 ~ /^.....w|^........w|s|t/' contents)" "" "files of others, or that others may write"
expect_equal "$(awk '$1 ~ /^-..x/ { print $3 }' contents | sort | xargs)" "./usr/bin/rpsup ./usr/bin/rpsup-validate" "what can be run"
dpkg-deb --control "$package" control
expect_equal "$(cat control/conffiles)" /etc/rpsup/config.ini "files that an administrator changes"
for script in postinst prerm postrm; do
  [ "$(stat --format=%a "control/$script")" = 755 ] || fail "dpkg cannot run $script"
  sh -n "control/$script"
done
dpkg-deb --extract "$package" root
(cd root && md5sum --check --quiet ../control/md5sums)

# The program, its manual page and its completion.
expect_equal "$(root/usr/bin/rpsup --version)" "$("$rpsup" --version)" "the program's version"
file_sections() { readelf --section-headers "$1" | grep -cE '\.(debug_info|symtab)' || true; }
expect_equal "$(file_sections root/usr/bin/rpsup)" 0 "sections for debuggers"
zcat root/usr/share/man/man1/rpsup.1.gz >page.1
! command -v mandoc >/dev/null || mandoc -T lint -W error page.1
expect_text page.1 'token.-file'
expect_text root/usr/share/bash-completion/completions/rpsup token-file

# The configuration as it is runs a service, but for the place of its store and its port.
sed -e "s#^db=.*#db=$folder/store.db#" -e 's/^port=.*/port=0/' root/etc/rpsup/config.ini >config.ini
: >ready
root/usr/bin/rpsup serve --config config.ini >ready 2>log &
service=$!
for ((tenths = 0; tenths < 100; ++tenths)); do
  url=$(sed -n 's/^rpsup listens on //p' ready)
  [ -z "$url" ] || break
  sleep 0.1
done
expect_equal "$(status_of "${url:?the packaged configuration does not start}/readyz")" 200 "readiness with the packaged configuration"
stop_service TERM

# The unit: without a fault, and closed to more than most of a machine's services.
if command -v systemd-analyze >/dev/null; then
  unit=root/usr/lib/systemd/system/rpsup.service
  sed "s#/usr/bin/rpsup#$folder/root/usr/bin/rpsup#" "$unit" >rpsup.service
  systemd-analyze verify --man=no ./rpsup.service >verify 2>&1 || { cat verify; fail "the unit has faults"; }
  ! grep -F rpsup.service verify || fail "the unit has faults"
  systemd-analyze security --offline=yes --threshold=15 --no-pager ./rpsup.service >security || { cat security; fail "the unit is more open than 1.5 of 10"; }
  tail -n 1 security
fi

# The service calls the system for nothing that the unit forbids it, from its start through a job, a copy of the store and its end.
allowed() {
  systemd-analyze syscall-filter --no-pager "$1" | sed -n '2,$s/^ *\([^# ]\)/\1/p' | while read -r name; do
    case "$name" in @*) allowed "$name" ;; *) echo "$name" ;; esac
  done
}
if command -v strace >/dev/null && command -v systemd-analyze >/dev/null; then
  allowed @privileged | sort -u >forbidden
  allowed @system-service | sort -u | comm -23 - forbidden >permitted
  [ "$(wc -l <permitted)" -gt 100 ] || fail "the list of system calls was not read"
  : >ready
  strace --follow-forks --quiet=all --output trace root/usr/bin/rpsup serve --config config.ini >ready 2>log &
  tracer=$!
  for ((tenths = 0; tenths < 100; ++tenths)); do
    url=$(sed -n 's/^rpsup listens on //p' ready)
    [ -z "$url" ] || break
    sleep 0.1
  done
  id=$(get --data '{"parameters": {"duration_s": 0.05, "run_up_s": 0.02}, "sweep": {"clearance_mm": [0, 0.2]}}' "$url/v1/sweeps" | jq -r .id)
  wait_for_end "$id"
  get --output copy.db "$url/v1/store"
  kill -TERM "$(awk 'NR == 1 { print $1 }' trace)"
  wait "$tracer"
  # The call that starts the program comes before the filter. SQLite as root gives its new files their owner; the unit's user is not root.
  before=execve
  [ "$(id -u)" -ne 0 ] || before='execve|fchown'
  sed -n 's/^[0-9]* *\([a-z0-9_]*\)(.*/\1/p' trace | sort -u | grep -vxE "$before" >called
  expect_equal "$(comm -23 called permitted | tr '\n' ' ')" "" "system calls that the unit forbids"
  ! grep -E '(mprotect|pkey_mprotect)\(.*PROT_EXEC|mmap\(.*PROT_WRITE\|PROT_EXEC' trace || fail "memory is made executable"
  echo "$(wc -l <called | tr -d ' ') system calls, all of them permitted"
fi
echo "the package holds what it should"
