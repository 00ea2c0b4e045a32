# Running named steps and counting how they end. Sourced.
# shellcheck shell=sh

# A step that cannot run here ends with this status; the last line it printed is the reason.
skip_status=77

skip() {
    printf '%s\n' "$*"
    exit $skip_status
}

begin_steps() {
    step_log=$(mktemp) || exit 1
    trap 'rm -f "$step_log" "$step_log.beside"; [ -z "$beside_process" ] || kill "$beside_process" 2>/dev/null' EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM
    passed=0
    failed=0
    skipped=0
    failed_names=
    skip_reasons=
    beside=
    beside_process=
}

# begin_beside NAME COMMAND...: begins a step beside the others; run_step of this name waits for its end.
begin_beside() {
    beside=$1
    beside_began=$(date +%s)
    shift
    ("$@") >"$step_log.beside" 2>&1 </dev/null &
    beside_process=$!
}

# run_step NAME COMMAND...: one line with the outcome and the time; all of the output only if it failed.
run_step() {
    step_name=$1
    shift
    printf '%-10s ' "$step_name"
    if [ "$step_name" = "$beside" ]; then
        began=$beside_began
        wait "$beside_process"
        step_status=$?
        beside_process=
        mv -f "$step_log.beside" "$step_log"
    else
        began=$(date +%s)
        ("$@") >"$step_log" 2>&1 </dev/null
        step_status=$?
    fi
    seconds=$(($(date +%s) - began))
    case $step_status in
        0)
            passed=$((passed + 1))
            printf 'passed   %4d s\n' $seconds
            ;;
        "$skip_status")
            skipped=$((skipped + 1))
            reason=$(tail -n 1 "$step_log")
            skip_reasons="$skip_reasons
skipped $step_name: $reason"
            printf 'skipped  %4d s\n' $seconds
            ;;
        *)
            failed=$((failed + 1))
            failed_names="$failed_names $step_name"
            printf 'FAILED   %4d s\n' $seconds
            cat "$step_log"
            ;;
    esac
}

# Prints the summary and ends the script.
end_steps() {
    printf '%s\n' "$skip_reasons"
    [ "$failed" -eq 0 ] || printf 'failed:%s\n' "$failed_names"
    printf '%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
    [ "$failed" -eq 0 ]
    exit
}
