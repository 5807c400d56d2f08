#!/usr/bin/env bash
# Checks that the targets of links between the pages of the repository exist, files as well as headings.
# Links to other sites are not followed. usage: check_links.sh REPOSITORY
set -euo pipefail
cd "$1"

pages() {
    find . -maxdepth 1 -name '*.md'
    find docs -name '*.md'
}

# Lines outside of fenced blocks, as `line:text` with inline code taken out.
prose() {
    awk '/^ *```/ { fenced = !fenced; next } !fenced { gsub(/`[^`]*`/, ""); print NR ":" $0 }' "$1"
}

links() { # as `line target`
    prose "$1" | awk '{
        line = $0
        sub(/:.*/, "", line)
        text = substr($0, length(line) + 2)
        while (match(text, /\]\([^()]*\)/)) {
            target = substr(text, RSTART + 2, RLENGTH - 3)
            sub(/[ \t].*/, "", target)
            print line, target
            text = substr(text, RSTART + RLENGTH)
        }
        if (match($0, /^[0-9]+:\[[^]]+\]: +[^ ]+/)) {
            target = substr($0, RSTART, RLENGTH)
            sub(/^.*\]: +/, "", target)
            print line, target
        }
    }'
}

# The anchors that headings of a page get: lower case, punctuation dropped, blanks as hyphens.
anchors() {
    awk '/^ *```/ { fenced = !fenced; next }
         !fenced && /^#+ / {
             sub(/^#+ +/, "")
             gsub(/\]\([^)]*\)/, "")
             text = tolower($0)
             gsub(/[^a-z0-9 _-]/, "", text)
             gsub(/ /, "-", text)
             print (seen[text]++ ? text "-" seen[text] - 1 : text)
         }' "$1"
}

wrong=0
complain() {
    echo "$1" >&2
    wrong=1
}

count=0
while read -r page; do
    while read -r line target; do
        count=$((count + 1))
        case $target in
        http://* | https://* | mailto:*) continue ;;
        esac
        file=${target%%#*}
        anchor=
        [[ $target != *"#"* ]] || anchor=${target#*#}
        path=$page
        [[ -z $file ]] || path=$(dirname "$page")/$file
        if [[ ! -e $path ]]; then
            complain "$page:$line: the target of the link $target does not exist"
        elif [[ -n $anchor && $path == *.md ]] && ! anchors "$path" | grep -qxF -- "$anchor"; then
            complain "$page:$line: $path has no heading for #$anchor"
        fi
    done < <(links "$page")
done < <(pages)
echo "$count links looked at"
exit $wrong
