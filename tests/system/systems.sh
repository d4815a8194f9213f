# SPDX-License-Identifier: Apache-2.0
# Systems to try packages in, and the paper's sweep to try them with. Sourced after helpers.sh; expects the folder of the sources in `sources`.
source "$sources/packaging/debian/system.sh"
mirror=$(apt-get indextargets "Codename: $(. /etc/os-release; echo "$VERSION_CODENAME")" 'Created-By: Packages' --format '$(SITE)' | head -n 1)

skip() { echo "skipped: $*"; exit 77; }

# need_mirror: the packages' systems come from the network; with it, whatever fails is a fault
need_mirror() {
  [ -n "$mirror" ] || skip "this machine has no source of Debian packages"
  curl --silent --show-error --fail --retry 2 --max-time 30 --output Release "$mirror/dists/stable/Release" 2>mirror.log || skip "no mirror is reachable: $(tail -n 1 mirror.log)"
  [ "$(id -u)" -eq 0 ] || skip "only root can start programs in another system's root"
}

# make_packages OPTION: of script/package
make_packages() {
  "$sources/script/package" "$1" "$preset" >package.log || { cat package.log; fail "script/package $1 failed"; }
  grep '^package: ' package.log
  package=$sources/$(sed -n '$s/^package: \([^,]*\),.*/\1/p' package.log)
}

# unpack_system RELEASE FOLDER: a system of that release, which is made once a week
unpack_system() {
  local cached=$sources/build/debian/$1.tar
  mkdir -p "$sources/build/debian"
  if [ -z "$(find "$cached" -mtime -7 2>/dev/null)" ]; then
    make_system "$1" "$cached.tar" --variant=minbase
    mv "$cached.tar" "$cached"
  fi
  mkdir "$2"
  tar --extract --file "$cached" --directory "$2" --exclude './dev/*'
  mknod --mode=666 "$2/dev/null" c 1 3
  mknod --mode=666 "$2/dev/urandom" c 1 9
}

# readme_block MARK: the shell commands that README.md has below the line <!-- run by a test, MARK -->
readme_block() {
  awk -v mark="<!-- run by a test, $1 -->" '
    $0 == mark { marked = 1; next }
    marked && /^```sh$/ { inside = 1; marked = 0; blocks++; next }
    inside && /^```$/ { inside = 0; next }
    inside { print }
    END { if (blocks != 1) { print "not one block is marked as " mark > "/dev/stderr"; exit 1 } }
  ' "$sources/README.md"
}

# check_study RESULTS.json: its 40 jobs succeeded, and the paper's seven statements hold
check_study() {
  expect_equal "$(jq -c '[length, (map(select(.state == "succeeded")) | length)]' "$1")" "[40,40]" "jobs of the study, and those that succeeded"
  "$rpsup" paper "$1" >statements
  expect_equal "$(grep -c '^[1-7] .* holds$' statements)" 7 "statements of the paper that hold"
}

# computed RESULTS.json: what is computed, of each job
computed() {
  jq --sort-keys --compact-output 'map(del(.job_id)) | sort_by(.clearance_mm, .crank_velocity_rad_s, .coupler, .replicate)' "$1"
}
