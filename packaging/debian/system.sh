# SPDX-License-Identifier: Apache-2.0
# Makes the root of a Debian system in a file, for the container image and for the tests of the packages. Sourced.

# make_system RELEASE FILE.tar [OPTION-OF-MMDEBSTRAP...]: of this machine's release from where this machine has its packages, of another from the same mirror
make_system() {
  local release=$1 file=$2 log sources codename option proxy
  shift 2
  log=$(mktemp)
  codename=$(. /etc/os-release; echo "$VERSION_CODENAME")
  if [ "$release" = "$codename" ]; then
    sources=$(apt-get indextargets 'Created-By: Packages' 'Origin: Debian' --format 'deb $(SITE) $(RELEASE) $(COMPONENT)' | sort -u)
  else
    sources="deb $(apt-get indextargets "Codename: $codename" 'Created-By: Packages' --format '$(SITE)' | head -n 1) $release main"
  fi
  local options=()
  for option in Acquire::http::Proxy Acquire::https::Proxy; do
    proxy=$(apt-config shell value "$option" | sed "s/^value='\(.*\)'$/\1/")
    [ -z "$proxy" ] || options+=("--aptopt=$option \"$proxy\"")
  done
  if ! mmdebstrap "${options[@]}" "$@" "$release" "$file" - <<<"$sources" >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    rm -f "$log" "$file"
    echo "a system of Debian's release $release could not be made" >&2
    return 1
  fi
  rm -f "$log"
}
