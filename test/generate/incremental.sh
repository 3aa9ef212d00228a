#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# incremental.sh TREE GENERATOR: a project that adds this tree and one map of its own regenerates exactly when the map
# or the program `coupler`, which holds the templates, changes, and compiles only what became different.
set -euo pipefail
tree=$1
generator=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat > CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.16)
project(tiny LANGUAGES CXX)
set(BUILD_TESTING OFF)
add_subdirectory(${TREE} coupler EXCLUDE_FROM_ALL)
coupler_add_map(cell cell.yaml DOCS)
END
cat > cell.yaml <<'END'
name: cell
mapping:
  coils: {lamp: 0}
END

fail() { echo "FAILED: $*"; tail -n 30 log; exit 1; }
build() { cmake --build build -j2 > log 2>&1; }
made=(build/cell_generated/cell.stamp build/cell_generated/cell_docs.stamp build/cell_generated/cell.html
      build/cell_generated/cell.md build/cell_generated/cell_map.cpp build/cell_generated/cell_map.hpp
      build/cell_generated/cell_node.cpp build/CMakeFiles/cell_map.dir/cell_generated/cell_map.cpp.o
      build/CMakeFiles/cell_node.dir/cell_generated/cell_node.cpp.o)

# after RULE FILE…: builds; exactly these files must have become newer.
after() {
  local rule=$1 file before
  shift
  declare -A before
  for file in "${made[@]}"; do before[$file]=$(stat -c %y "$file"); done
  build || fail "$rule: the build failed"
  for file in "${made[@]}"; do
    local now changed=no expected=no
    now=$(stat -c %y "$file")
    [[ $now != "${before[$file]}" ]] && changed=yes
    for wanted in "$@"; do [[ ${file##*/} == "$wanted" ]] && expected=yes; done
    [[ $changed == "$expected" ]] || fail "$rule: ${file##*/} newer: $changed, expected: $expected"
  done
  echo "ok: $rule"
}

# Without -g ccache serves objects that were compiled in another folder.
cmake -S . -B build -G "$generator" -DTREE="$tree" -DCMAKE_BUILD_TYPE=None -DCOUPLER_WERROR=ON -DCOUPLER_ROS=OFF > log 2>&1 ||
  fail "configuring"
build || fail "the first build"
program=$(find build -type f -name coupler -perm -u+x)
[[ $(cat build/cell_generated/*) != *"$work"* ]] || fail "a generated file names the folder it was made in"

after "nothing changed: nothing is done"
touch cell.yaml
after "a map that was only touched compiles nothing" cell.stamp cell_docs.stamp
after "and is then up to date"
sed -i '1i # A remark.' cell.yaml
after "a remark in the map is served by the node: the table is compiled" \
  cell.stamp cell_docs.stamp cell.html cell.md cell_map.cpp cell_map.cpp.o
echo '  discrete_inputs: {button: 0}' >> cell.yaml
after "another point is another fingerprint: both programs see it" \
  cell.stamp cell_docs.stamp cell.html cell.md cell_map.cpp cell_map.hpp cell_map.cpp.o cell_node.cpp.o
touch "$program"
after "another generator runs, and what it makes alike compiles nothing" cell.stamp cell_docs.stamp
after "and is up to date again"

sed -i 's/lamp: 0/lamp: /' cell.yaml
! build || fail "an address without a lock did not stop the build"
grep -q 'there is no .*cell\.yaml\.lock; run `coupler check' log || fail "the build does not say that a lock is missing"
[[ ! -e cell.yaml.lock ]] || fail "the build wrote a lock"
"$program" check cell.yaml > log
after "a lock that comes up is found" \
  cell.stamp cell_docs.stamp cell_map.cpp cell_map.cpp.o
after "and is then up to date"
sed -i 's/^coils 0 lamp/coils 5 lamp/' cell.yaml.lock
after "another lock is another map" \
  cell.stamp cell_docs.stamp cell.html cell.md cell_map.cpp cell_map.hpp cell_map.cpp.o cell_node.cpp.o
rm cell.yaml.lock
! build || fail "a lock that is gone did not stop the build"
sed -i 's/lamp: /lamp: 0/' cell.yaml
build || fail "the map with its address again"

sed -i 's/lamp: 0/lamp: 70000/' cell.yaml
! build || fail "a bad map did not stop the build"
grep -Eq 'cell\.yaml:4:[0-9]+: error: ' log || fail "the build does not say what is wrong with the map"
sed -i 's/lamp: 70000/lamp: 7/' cell.yaml
after "a bad map stops the build with its place, and a repaired one goes on" \
  cell.stamp cell_docs.stamp cell.html cell.md cell_map.cpp cell_map.hpp cell_map.cpp.o cell_node.cpp.o
