#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The container image: loaded by podman and started as its user finds it, it asks for a token, computes the paper's sweep and keeps it.
#   image_test.sh RPSUP SOURCES PRESET
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
sources=$2 preset=$3
source "$sources/tests/system/systems.sh"
need_mirror
make_packages --image
version=$(basename "$package" -image.tar)
version=${version#rpsup-}
tag=${version//[^A-Za-z0-9_.-]/-}

# Its parts are what their digests say, and others read it, too.
tar --extract --file "$package"
config=$(jq -r '.[0].Config' manifest.json)
layer=$(jq -r '.[0].Layers[0]' manifest.json)
expect_equal "$(jq -c '.[0].RepoTags' manifest.json)" "[\"rpsup:$tag\",\"rpsup:latest\"]" "names"
expect_equal "$(sha256sum "$config" | cut -d' ' -f1).json" "$config" "digest of the configuration"
expect_equal "$(zcat "$layer" | sha256sum | cut -d' ' -f1)" "$(jq -r '.rootfs.diff_ids[0]' "$config" | cut -d: -f2)" "digest of the layer's files"
if command -v skopeo >/dev/null; then
  expect_equal "$(skopeo inspect "docker-archive:$package:rpsup:$tag" | jq -r '.Labels."org.opencontainers.image.version"')" "$version" "version by skopeo"
fi

mkdir root
tar --extract --gzip --file "$layer" --directory root --exclude './dev/*'
mknod --mode=666 root/dev/null c 1 3
mknod --mode=666 root/dev/urandom c 1 9
expect_equal "$(find root/var/lib/apt/lists root/root root/tmp root/var/log -type f -size +0 ! -name ".*")" "" "files that are left over"
expect_equal "$(stat --format='%u:%g %a' root/var/lib/rpsup)" "$(jq -r .config.User "$config") 700" "owner and mode of the store's folder"

token=$(openssl rand -hex 24)
port=8080  # the image's own
! curl --silent --output /dev/null "http://127.0.0.1:$port/" || fail "another program has the port $port, which the image's service takes"

podman=(podman --root "$folder/storage" --runroot "$folder/run" --storage-driver vfs --cgroup-manager cgroupfs --events-backend file --log-level fatal)
limits=(--ulimit nofile=1024:1024 --ulimit nproc=1024:1024)  # no more than the caller may have
command -v runc >/dev/null && podman+=(--runtime runc)
leave_container() {
  "${podman[@]}" rm --force --all >/dev/null 2>&1 || true
  leave
}
if command -v podman >/dev/null && "${podman[@]}" load --quiet --input "$package" >load.log 2>&1 &&
    "${podman[@]}" run --rm --network host "${limits[@]}" --entrypoint true "rpsup:$tag" >>load.log 2>&1; then
  trap leave_container EXIT
  # As README.md says it, in a network that needs no set-up of the machine's.
  readme_block 'from the image' | sed -e 's/ -p [^ ]* / --network host /' -e "s# build/package/rpsup-\*-image.tar# $package#" -e "s/\$(openssl[^)]*)/$token/" >session.sh
  grep -q -e '--network host' session.sh || fail "README.md publishes no port"
  podman() {
    local options=()
    [ "$1" != run ] || options=("${limits[@]}")
    command "${podman[@]}" "$1" "${options[@]}" "${@:2}"
  }
  start() { source ./session.sh >started 2>&1; }
  check_health() { podman healthcheck run rpsup; }
  stop() {
    podman stop --time 30 rpsup >stopped
    code=$(podman inspect rpsup | jq '.[0].State.ExitCode')
    podman rm rpsup >stopped
  }
  how=podman
else
  # Containers cannot be started everywhere: its files, its user, its command and its check of health can.
  tail -n 1 load.log 2>/dev/null || true
  mapfile -t command < <(jq -r '.config.Entrypoint[]' "$config")
  mapfile -t health < <(jq -r '.config.Healthcheck.Test[1:][]' "$config")
  in_image=(chroot --userspec="$(jq -r .config.User "$config")" root env -i PATH=/usr/bin:/bin)
  start() { "${in_image[@]}" RPSUP_TOKEN="$token" "${command[@]}" >ready 2>log & service=$!; }
  check_health() { "${in_image[@]}" "${health[@]}"; }
  stop() { stop_service TERM; }
  how=chroot
fi

# Without a token it does not start, and says why.
code=0
if [ $how = podman ]; then podman run --rm --network host "rpsup:$tag" >out 2>&1 || code=$?; else "${in_image[@]}" "${command[@]}" >out 2>&1 || code=$?; fi
expect_equal "$code" 2 "exit code without a token"
expect_text out 'without a token'

url=http://127.0.0.1:$port
wait_until_ready() {
  local tenths
  for ((tenths = 0; tenths < 300; ++tenths)); do
    if [ "$(status_of "$url/readyz")" = 200 ]; then return; fi
    sleep 0.1
  done
  fail "the service was not ready within 30 s"
}
! check_health 2>/dev/null || fail "what is not there is healthy"
start
wait_until_ready
check_health || fail "the service is not healthy"
expect_equal "$(status_of "$url/v1/sweeps")" 401 "an answer without the token"
authorized=(--header "Authorization: Bearer $token")
id=$(get "${authorized[@]}" --data "@$sources/script/paper.json" "$url/v1/sweeps" | jq -r .id)
for ((tenths = 0; tenths < 3000; ++tenths)); do
  case "$(get "${authorized[@]}" "$url/v1/sweeps/$id" | jq -r .state)" in queued | running) sleep 0.1 ;; *) break ;; esac
done
get "${authorized[@]}" "$url/v1/sweeps/$id/results" >study.json
check_study study.json
stop
expect_equal "$code" 0 "exit code of the service"
# Another container finds what the first one left.
start
wait_until_ready
expect_equal "$(get "${authorized[@]}" "$url/v1/sweeps/$id" | jq -r .state)" succeeded "state of the study after a restart"
stop
echo "the image works, by $how"
