#!/usr/bin/env bash
# Sets up, builds `tenon` and runs its main jobs on real input; each leaves its records in build/demo. Ends at the first failure.
# A second run does only what changed: a job runs again where its command, its input or the program is newer than its record.
source "$(dirname "$0")/setup.sh"

install_packages
configure release
build release --target tenon

tenon=build/release/tenon
records=build/demo
mkdir -p "$records"

# job NAME COMMAND...: prints the command and what it says, and keeps both in build/demo/NAME.txt.
job() {
  local record=$records/$1.txt
  shift
  echo
  echo "\$ $*"
  if up_to_date "$record" "$@"; then
    tail -n +2 "$record"
    echo "(from $record: nothing has changed since)"
    return
  fi
  { echo "\$ $*"; } > "$record.partial"
  "$@" | tee -a "$record.partial"
  mv "$record.partial" "$record"
}

# Whether the record tells of this very command, every file that it names (the program among them) is there and older.
up_to_date() {
  local record=$1 previous="" word
  shift
  [[ -f $record && $(head -n 1 "$record") == "\$ $*" ]] || return 1
  for word in "$@"; do
    if [[ -e $word && $word -nt $record ]]; then return 1; fi
    if [[ $previous == --output && ! -e $word ]]; then return 1; fi
    previous=$word
  done
}

job hover "$tenon" allocate momav --wrenches problems/allocation/hover_sweep.csv --output "$records/hover.csv"
job compare_classic "$tenon" compare hs071 hs100 --output "$records/compare_classic.csv"
job compare_momav "$tenon" compare momav --rows 20 --seed 1 --output "$records/compare_momav.csv"
job flight "$tenon" fly orientation-sweep --output "$records/flight.csv" --events "$records/flight_events.csv"
job cradle "$tenon" simulate cradle --output "$records/cradle.csv" --events "$records/cradle_events.csv"
job bouncing_ball "$tenon" simulate bouncing-ball --output "$records/ball.csv" --events "$records/ball_events.csv"
job plan "$tenon" plan bouncing-ball-catch --output "$records/plan.csv"
job mpc "$tenon" mpc peg-in-hole --seed 3 --output "$records/peg.csv"
job sweep "$tenon" sweep peg-in-hole --samples 100 --baselines --output "$records/sweep.csv"
job bench_allocation "$tenon" bench allocation
job report "$tenon" report "$records"/{hover,flight,plan,peg,sweep,compare_classic,compare_momav}.csv --output "$records/report.html"

echo
echo "Every job is done; the records are in $records. To see them, open $records/report.html in a browser."
