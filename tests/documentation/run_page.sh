#!/usr/bin/env bash
# Runs the snippets of one page of the documentation, in order, in a folder of its own.
# usage: run_page.sh PAGE REPOSITORY WORK_FOLDER
#
# The words after the language of a fenced block say what is done with it:
#   ```sh run            run by bash; must exit with 0
#   ```sh run fails=N    run by bash; must exit with N
#   ```sh run needs=WHAT    run by bash if WHAT is installed, a program or python3:MODULE; else skipped
#   ```text output       exactly the standard output of the block run before
#   ```toml file=NAME    written to NAME before the following blocks are run (any language but cpp)
#   ```cpp file=PATH     the whole file PATH of the repository
#   ```cpp part-of=PATH  consecutive lines of the file PATH of the repository (any language)
#   ```python needs=WHAT, ```python not-run  left to tests/python/test_documentation.py
# Blocks without further words are not tested.
set -euo pipefail

page=$(realpath "$1")
repository=$(realpath "$2")
work=$3
rm -rf "$work"
mkdir -p "$work/snippets" "$work/run"
work=$(realpath "$work")

fail() { # LINE MESSAGE
    echo "$page:$1: $2" >&2
    exit 1
}

# Writes one line for each block into $work/list, with its line, number, language and purpose, and its text into snippets/.
awk -v folder="$work/snippets" '
    match($0, /^ *```+/) && !fence {
        marks = substr($0, 1, RLENGTH)
        indent = index(marks, "`") - 1
        fence = RLENGTH - indent
        words = substr($0, RLENGTH + 1)
        gsub(/^[ \t]+|[ \t\r]+$/, "", words)
        start = NR
        file = folder "/" ++count
        printf "" > file
        print start, count, words
        next
    }
    fence && match($0, /^ *```+[ \t\r]*$/) {
        closing = $0
        gsub(/[^`]/, "", closing)
        if (length(closing) >= fence) {
            close(file)
            fence = 0
            next
        }
    }
    fence {
        line = $0
        for (i = 0; i < indent && substr(line, 1, 1) == " "; ++i)
            line = substr(line, 2)
        print line > file
    }
    END {
        if (fence) {
            print start, count, "unclosed fence"
        }
    }' "$page" >"$work/list"

is_part_of() { # SNIPPET FILE
    awk 'NR == FNR { part[n++] = $0; next }
         { whole[m++] = $0 }
         END {
             for (i = 0; i + n <= m; ++i) {
                 for (j = 0; j < n && part[j] == whole[i + j]; ++j) {}
                 if (j == n) exit 0
             }
             exit 1
         }' "$1" "$2"
}

is_there() { # PROGRAM[:MODULE]
    command -v "${1%%:*}" >/dev/null && { [[ $1 != *:* ]] || "${1%%:*}" -c "import ${1#*:}" 2>/dev/null; }
}

passed_over=false
run_snippet() { # EXPECTED_STATUS: runs the current block
    local status=0
    passed_over=false
    bash -euo pipefail "$snippet" </dev/null >"$work/output" || status=$?
    cat "$work/output"
    [[ $status == "$1" ]] || fail "$line" "the snippet ended with $status instead of $1"
    ran=$((ran + 1))
}

ran=0
cd "$work/run"
while read -r line number language purpose <&3; do
    snippet=$work/snippets/$number
    case "$language $purpose" in
    *" ") ;;
    "unclosed fence") fail "$line" "the block that begins here never ends" ;;
    "sh run needs="*)
        needed=${purpose#run needs=}
        [[ $needed =~ ^[A-Za-z0-9_.+:-]+$ ]] || fail "$line" "needs= takes a program or python3:MODULE: $purpose"
        if ! is_there "$needed"; then
            echo "$page:$line: skipped, since $needed is not installed"
            passed_over=true
            continue
        fi
        run_snippet 0
        ;;
    "sh run" | "sh run fails="*)
        expected=${purpose#run}
        expected=${expected# fails=}
        expected=${expected:-0}
        [[ $expected =~ ^[0-9]+$ ]] || fail "$line" "fails= needs a number: $purpose"
        run_snippet "$expected"
        ;;
    "text output")
        [[ $passed_over == false ]] || continue
        [[ -e $work/output ]] || fail "$line" "no snippet has been run whose output this could be"
        diff -u --label documented "$snippet" --label printed "$work/output" >&2 ||
            fail "$line" "the snippet before prints something else"
        ;;
    *" part-of="*)
        file=${purpose#part-of=}
        [[ -f $repository/$file ]] || fail "$line" "there is no file $file"
        [[ -s $snippet ]] || fail "$line" "an empty block is part of everything"
        is_part_of "$snippet" "$repository/$file" || fail "$line" "these lines are not part of $file"
        ran=$((ran + 1))
        ;;
    "cpp file="*)
        file=${purpose#file=}
        [[ -f $repository/$file ]] || fail "$line" "there is no file $file"
        diff -u --label documented "$snippet" --label "$file" "$repository/$file" >&2 ||
            fail "$line" "the snippet is not the file $file"
        ran=$((ran + 1))
        ;;
    "python needs="* | "python not-run") ;;
    *" file="*)
        file=${purpose#file=}
        [[ $file =~ ^[A-Za-z0-9_.-]+$ ]] || fail "$line" "a file's name must be plain: $file"
        cp "$snippet" "$file"
        ;;
    *) fail "$line" "unknown purpose of a block: $language $purpose" ;;
    esac
done 3<"$work/list"
echo "$page: $ran snippets run or compared"
