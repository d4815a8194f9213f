#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails if a script or linkage of web/ is missing in web/files.cmake: the service would answer 404 for it.
#   pages_are_embedded.sh SOURCE_FOLDER
set -euo pipefail
cd "$1/web"
missing=0
while read -r page; do
  grep -qxF "  $page" files.cmake || { echo "$page is missing in web/files.cmake"; missing=1; }
done < <(find . -path ./node_modules -prune -o \( -name '*.js' -o -path './linkages/*.json' \) -printf '%P\n' | grep / | sort)
exit "$missing"
