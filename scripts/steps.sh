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
    trap 'rm -f "$step_log" "$step_log".*; [ -z "$beside" ] || kill $beside 2>/dev/null' EXIT
    trap 'exit 130' INT
    trap 'exit 143' TERM
    passed=0
    failed=0
    skipped=0
    failed_names=
    skip_reasons=
    beside=
    : >"$step_log.beside"
}

# begin_beside NAME COMMAND...: begins a step beside the others; end_steps waits for its end.
begin_beside() {
    step_name=$1
    shift
    began=$(date +%s)
    {
        ("$@")
        step_status=$?
        date +%s >"$step_log.$step_name.end"
        exit $step_status
    } >"$step_log.$step_name" 2>&1 </dev/null &
    beside="$beside $!"
    echo "$! $step_name $began" >>"$step_log.beside"
}

# run_step NAME COMMAND...: one line with the outcome and the time; all of the output only if it failed.
run_step() {
    step_name=$1
    shift
    printf '%-10s ' "$step_name"
    began=$(date +%s)
    ("$@") >"$step_log" 2>&1 </dev/null
    end_step $? "$step_log" "$(date +%s)"
}

# end_step STATUS LOG END: the rest of the line of step `step_name`, which began at `began`.
end_step() {
    case $1 in
        0)
            passed=$((passed + 1))
            outcome=passed
            ;;
        "$skip_status")
            skipped=$((skipped + 1))
            outcome=skipped
            skip_reasons="$skip_reasons
skipped $step_name: $(tail -n 1 "$2")"
            ;;
        *)
            failed=$((failed + 1))
            outcome=FAILED
            failed_names="$failed_names $step_name"
            ;;
    esac
    printf '%-8s %4d s\n' $outcome $(($3 - began))
    [ $outcome != FAILED ] || cat "$2"
}

# Waits for the steps beside, prints the summary and ends the script.
end_steps() {
    while [ -n "$beside" ] && read -r process step_name began <&3; do
        printf '%-10s ' "$step_name"
        wait "$process"
        end_step $? "$step_log.$step_name" "$(cat "$step_log.$step_name.end")"
    done 3<"$step_log.beside"
    beside=
    printf '%s\n' "$skip_reasons"
    [ "$failed" -eq 0 ] || printf 'failed:%s\n' "$failed_names"
    printf '%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
    [ "$failed" -eq 0 ]
    exit
}
