#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# cmake --install puts everything below its prefix, and what it has put there works, moved elsewhere too.
#   install_test.sh RPSUP SOURCES PRESET
source "$(dirname "${BASH_SOURCE[0]}")/helpers.sh"
sources=$2 preset=$3
DESTDIR='' cmake --install "$sources/build/$preset" --prefix "$folder/first" >install.log
sed -n 's/^-- [A-Z][-a-z]*: //p' install.log | grep -vF "$folder/first/" >outside || true
expect_equal "$(cat outside)" "" "files outside of the prefix"
cd "$folder"
(cd 'first' && find . -type f ! -path './bin/*') | sort >files
cat >expected <<'FILES'
./lib/systemd/system/rpsup.service
./share/bash-completion/completions/rpsup
./share/doc/rpsup/NOTICE
./share/doc/rpsup/copyright
./share/doc/rpsup/examples/config.ini
./share/doc/rpsup/examples/paper.json
./share/fish/vendor_completions.d/rpsup.fish
./share/man/man1/rpsup.1.gz
./share/rpsup/octave/rpsup.m
./share/rpsup/python/rpsup/__init__.py
./share/rpsup/python/rpsup/client.py
./share/rpsup/python/rpsup/errors.py
./share/rpsup/python/rpsup/program.py
./share/rpsup/python/rpsup/progress.py
./share/rpsup/python/rpsup/py.typed
./share/rpsup/python/rpsup/study.py
./share/rpsup/python/rpsup/sweep.py
./share/rpsup/python/rpsup/table.py
./share/rpsup/python/rpsup/transport.py
./share/rpsup/python/rpsup/version.py
./share/zsh/site-functions/_rpsup
FILES
diff expected files || fail "the files are others"
expect_text 'first/lib/systemd/system/rpsup.service' "^ExecStart=$folder/first/bin/rpsup serve --config /etc/rpsup/config.ini$"
mv 'first' second
expect_equal "$(second/bin/rpsup --version)" "$("$rpsup" --version)" "version"
! readelf --dynamic second/bin/* | grep -E 'RPATH|RUNPATH' || fail "a program looks for libraries in the folder in which it was built"
echo '{"duration_s": 0.05, "run_up_s": 0.02}' | second/bin/rpsup simulate - >job.json
expect_equal "$(jq -r .state job.json)" succeeded "a job"

# Below /usr, what Debian has elsewhere stands there.
DESTDIR=$folder/staged cmake --install "$sources/build/$preset" --prefix /usr >install.log
for file in etc/rpsup/config.ini usr/share/zsh/vendor-completions/_rpsup; do [ -s "staged/$file" ] || fail "there is no /$file"; done
expect_text staged/usr/lib/systemd/system/rpsup.service '^ExecStart=/usr/bin/rpsup serve --config /etc/rpsup/config.ini$'
echo "cmake --install keeps to its prefix"
