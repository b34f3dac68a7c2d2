# fibrad.bash - completion of fibrad's commands, options and files in bash. SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# Installed as share/bash-completion/completions/fibrad; or: source host/cli/man/fibrad.bash. Commands and options are those
# that the program's own --help names.

_fibrad_commands() { # PROGRAM
    "$1" --help 2>/dev/null | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p'
}

_fibrad_options() { # PROGRAM COMMAND
    "$1" "$2" --help all 2>/dev/null | sed -n 's/^  \(-[A-Za-z]\), \(--[a-z-]*\).*/\1 \2/p; s/^  \(--[a-z-]*\) .*/\1/p'
}

_fibrad() {
    local program=${1/#\~/$HOME} current=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} words
    COMPREPLY=()
    test "$current" = = && current= # --option=FILE is three words
    if test "$COMP_CWORD" = 1; then
        words="$(_fibrad_commands "$program") help --help --version -h -V"
    elif test "$command" = help; then
        words=$(_fibrad_commands "$program")
    elif [[ $current == -* && " ${COMP_WORDS[*]:0:COMP_CWORD} " != *" -- "* ]]; then
        words=$(_fibrad_options "$program" "$command")
    else
        compopt -o filenames 2>/dev/null # a folder named as a command is none
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
        return
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}

complete -o bashdefault -F _fibrad fibrad
