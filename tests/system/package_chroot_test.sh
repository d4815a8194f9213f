#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian package in a fresh system of the same release, uses it, removes it and purges it.
#   package_chroot_test.sh RPSUP SOURCES PRESET
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
sources=$2 preset=$3
source "$sources/tests/system/systems.sh"
need_mirror
make_packages --deb
system=$folder/system
unpack_system "$(. /etc/os-release; echo "$VERSION_CODENAME")" "$system"
inside() { chroot "$system" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C DEBIAN_FRONTEND=noninteractive http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" "$@"; }
cp "$package" "$system/root/"
# The command of README.md, by root, who answers no questions.
readme_block 'from the Debian package' | sed -e 's/^sudo //' -e 's# ./build/package/# ./#' >"$system/root/session.sh"
echo 'APT::Get::Assume-Yes "true"; APT::Sandbox::User "root";' >"$system/etc/apt/apt.conf.d/test"
(cd "$system" && find etc usr var -xdev \( -type f -o -type l \) | sort) >before
inside apt-get --quiet=2 update >apt.log 2>&1
inside sh -euc 'cd /root; . ./session.sh' >>apt.log 2>&1 || { tail -n 30 apt.log; fail "the package cannot be installed"; }
expect_equal "$(inside dpkg-query --show --showformat='${db:Status-Status}' rpsup)" installed "state of the package"
inside dpkg --verify rpsup
[ -L "$system/etc/systemd/system/multi-user.target.wants/rpsup.service" ] || echo "the unit is not enabled, as there is no systemd in this system"

# A job, and the service, with what the package depends on and nothing else.
inside rpsup sweep /usr/share/doc/rpsup/examples/paper.json --db /root/study.db --results /root/study.json >study.log 2>&1 || { cat study.log; fail "the study cannot be computed"; }
check_study "$system/root/study.json"
echo '{"duration_s": 0.05, "run_up_s": 0.02}' >"$system/root/job.json"
expect_equal "$(inside rpsup simulate /root/job.json | jq -r .state)" succeeded "a job"
mkdir "$system/var/lib/rpsup"
sed -i 's/^port=.*/port=0/' "$system/etc/rpsup/config.ini"
: >ready
chroot "$system" /usr/bin/rpsup serve --config /etc/rpsup/config.ini >ready 2>log &
service=$!
for ((tenths = 0; tenths < 100; ++tenths)); do
  url=$(sed -n 's/^rpsup listens on //p' ready)
  [ -z "$url" ] || break
  sleep 0.1
done
expect_equal "$(status_of "${url:?the service does not start}/readyz")" 200 "readiness"
expect_equal "$(status_of --data @"$system/root/job.json" "$url/v1/jobs")" 201 "a job"
stop_service TERM
expect_equal "$code" 0 "exit code of the service"

# The Python package, with Debian's Python and nothing else; root leaves compiled modules behind.
inside apt-get --quiet=2 install python3 >>apt.log 2>&1
cat >"$system/root/study.py" <<'END'
import rpsup
with rpsup.start() as client:
    rows = client.submit(clearance_mm=[0, 0.2], duration_s=0.05, run_up_s=0.02).wait().rows()
print(rpsup.__file__, rpsup.__version__, len(rows))
END
expect_equal "$(inside python3 /root/study.py)" \
  "/usr/lib/python3/dist-packages/rpsup/__init__.py $(inside dpkg-query --show --showformat='${Version}' rpsup) 2" "the Python package"
[ -d "$system/usr/lib/python3/dist-packages/rpsup/__pycache__" ] || fail "Python compiled nothing, so that the test of what is left behind is none"

# Installed again it keeps what the administrator has changed; removed, too; purged, all but the results.
inside dpkg --install "/root/$(basename "$package")" >>apt.log 2>&1
expect_text "$system/etc/rpsup/config.ini" '^port=0$'
inside dpkg --remove rpsup >>apt.log 2>&1
[ ! -e "$system/usr/bin/rpsup" ] || fail "the program is still there"
expect_text "$system/etc/rpsup/config.ini" '^port=0$'
echo "RPSUP_TOKEN=secret" >"$system/etc/rpsup/environment"
inside dpkg --purge rpsup >>purge.log 2>&1
expect_text purge.log 'results in /var/lib/rpsup stay'
[ ! -e "$system/etc/rpsup" ] || fail "the configuration is still there"
[ -s "$system/var/lib/rpsup/rpsup.db" ] || fail "the results are gone"
(cd "$system" && find etc usr var -xdev \( -type f -o -type l \) | sort) >after
expect_equal "$(comm -13 before after | grep rpsup | grep -v '^var/lib/rpsup/' || true)" "" "what purging leaves behind"
echo "installed, used, removed and purged"
