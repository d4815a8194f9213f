#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the sources in a bare Debian 13, whose compiler and libraries are newer, and computes the paper's study there.
#   debian_13_test.sh RPSUP SOURCES
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
sources=$2
source "$sources/tests/system/systems.sh"
need_mirror
system=$folder/system
unpack_system trixie "$system"
mkdir "$system/root/rpsup"
git -C "$sources" ls-files -z | tar --create --directory "$sources" --null --files-from=- | tar --extract --directory "$system/root/rpsup"
echo 'APT::Sandbox::User "root";' >"$system/etc/apt/apt.conf.d/test"
# inside COMMAND...: in the system, with its processes to be seen and nothing of it mounted afterwards
inside() {
  unshare --mount --propagation private sh -c 'mount -t proc proc "$1/proc" && exec chroot "$@"' sh "$system" \
    env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" "$@"
}

inside apt-get --quiet=2 update >apt.log 2>&1 || { tail -n 20 apt.log; fail "Debian 13 has no lists of packages"; }
inside sh -euc 'cd /root/rpsup && script/build --own release rpsup' >build.log 2>&1 || { tail -n 40 build.log; fail "Debian 13 does not build the program"; }
cp "$sources/script/paper.json" "$system/root/"
inside /root/rpsup/build/release/rpsup sweep /root/paper.json --db /root/study.db --results /root/study.json >study.log 2>&1 || { cat study.log; fail "the study cannot be computed"; }
check_study "$system/root/study.json"
inside /root/rpsup/build/release/rpsup --version
