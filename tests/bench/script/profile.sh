# SPDX-License-Identifier: Apache-2.0
# Where the processor time of a job goes, by Linux's perf: for each case the shares of the phases, and with --functions the functions of
# one case. Sourced by script/bench; $@ cases, files with a job's parameters among them; none: all, and the four-bar.
command -v perf >/dev/null || { echo "script/bench: profile needs perf (Debian: linux-perf)" >&2; exit 2; }
functions=
if [ "${1:-}" = --functions ]; then
  functions=yes
  shift
fi
program=$root/build/bench/bench_profile
cases=("$@")
if [ ${#cases[@]} -eq 0 ]; then
  mapfile -t cases < <("$program" --list)
  cases+=("$root/web/linkages/four_bar.json")
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# profile CASE: "SHARE FUNCTION" for each function of jobs that take a second or more in all; on the descriptor 3 the time of a job
profile() {
  local once
  once=$("$program" "$1")
  perf record --quiet --event cpu-clock --freq 4000 --output "$scratch/data" \
    "$program" "$1" "$(awk -v ms="$once" 'BEGIN {print 1 + int(1500 / ms)}')" >&3 2>/dev/null ||
    { echo "script/bench: perf cannot record here" >&2; exit 1; }
  perf report --input "$scratch/data" --no-children --fields overhead,symbol --stdio 2>/dev/null |
    sed -n 's/^ *\([0-9.]*\)%  \[[.k]\] \(.*[^ ]\) *$/\1 \2/p'
}

if [ -n "$functions" ]; then
  profile "${cases[0]}" 3>/dev/null | sed 's/engine:://g' | cut -c1-140 | head -n 40
  return
fi
for each in "${cases[@]}"; do
  name=${each##*/}
  profile "$each" 3>"$scratch/time" | awk -v name="${name%.json}" '
    # The first pattern that fits a function names its phase. Contact laws are inlined into evaluations but for those of elements. Runs that
    # are solved, not integrated, evaluate constraints and inverse dynamics.
    /UnstableMode|Eigen::.*(Schur|Hessenberg|EigenSolver|ouseholder)/ {sums["stability checks"] += $1; next}
    /::factor/ {sums["factorisation"] += $1; next}
    /solve_pack/ {sums["Jacobian"] += $1; next}
    /solve_bodies/ {sums["evaluation"] += $1; next}
    /::solve|NewtonMatrix|RecursiveNewton|TreeRecursion|ContactUpdate/ && !/MotionSystem|ConstraintSolver|LoopClosure|KinematicRun/ {sums["solutions"] += $1; next}
    /[lL]inearis|OperatingPoint|Jacobian|SeedSchedule|DualOf|Tangent/ {sums["Jacobian"] += $1; next}
    /CompiledKernel|add_elements|ForwardDynamics|Constraint|InverseDynamics|calc_frame|acos|atan2/ {sums["evaluation"] += $1; next}
    /calc_driven_motion|sincos|move_drives/ {sums["drives"] += $1; next}
    /RunMetrics|RunChannels|RunObserver|RpsupObserver|SlidingWork|calc_ring_contact|std::_Function_handler|energy|potential|kinetic|interpolate/ {sums["observers, samples"] += $1; next}
    /Radau5|Rodas5|Dopri5|Integration|Tolerance|combine_stages|StepControl|pow_fma|MotionSystem|StepPoint|KinematicRun|LoopClosure/ {sums["integrator"] += $1; next}
    /advance|penetration|Penetration|ContactEvents|OnsetLatch/ {sums["contact events"] += $1; next}
    {sums["other"] += $1}
    END {for (phase in sums) printf "%s\t%s\t%.0f\n", name, phase, sums[phase]}' >>"$scratch/shares"
  printf '%s\tCPU of a job [ms]\t%s\n' "${name%.json}" "$(cat "$scratch/time")" >>"$scratch/shares"
done
echo
echo "Share of a job's processor time [%]"
echo
awk -F '\t' '
  !($1 in seen) {seen[$1] = 1; names[++count] = $1}
  {share[$2, $1] = $3}
  END {
    phases = split("evaluation|Jacobian|factorisation|solutions|stability checks|integrator|contact events|drives|observers, samples|other|CPU of a job [ms]", list, "|")
    line = "| phase |"; rule = "|---|"
    for (i = 1; i <= count; ++i) {line = line " " names[i] " |"; rule = rule "---:|"}
    print line; print rule
    for (p = 1; p <= phases; ++p) {
      line = "| " list[p] " |"
      for (i = 1; i <= count; ++i) line = line " " ((list[p], names[i]) in share ? share[list[p], names[i]] : 0) " |"
      print line
    }
  }' "$scratch/shares"
