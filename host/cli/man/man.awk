# man.awk - a manual page from the text of --help. SPDX-License-Identifier: MIT
#
# awk -v page=fibrad-bed -v purpose='view factors ...' -v version=0.3.0 -f host/cli/man/man.awk: usage lines, paragraphs,
# rows of options `  -o, --output OUT   text`, paragraphs with indented lines, `Examples:`. The page fibrad begins with
# `fibrad VERSION - purpose` instead and lists the commands.

# Text as groff prints it letter by letter.
function plain(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    gsub(/\^/, "\\(ha", text)
    gsub(/~/, "\\(ti", text)
    gsub(/'/, "\\(aq", text)
    gsub(/`/, "\\(ga", text)
    return text ~ /^\./ ? "\\&" text : text
}

function section(name) { end_block(); print ".SH " name; in_options = 0 }

# Lines that stay as they are.
function begin_block() { if (!in_block) print ".RS 4\n.nf"; in_block = 1 }
function end_block() { if (in_block) print ".fi\n.RE"; in_block = 0 }

# An option or a command with its text.
function term(head, text) { end_block(); print ".TP\n" head; print plain(text) }

# `-o, --output OUT`: names bold, the argument italic.
function names(head,   words, n, k, out) {
    n = split(head, words, " ")
    for (k = 1; k <= n; k++) {
        bold = words[k] ~ /^-/
        comma = sub(/,$/, "", words[k]) && bold ? "," : ""
        out = out (k > 1 ? " " : "") (bold ? "\\fB" : "\\fI") plain(words[k]) "\\fR" comma
    }
    return out
}

BEGIN {
    title = page
    gsub(/-/, "\\-", title)
    print ".\\\" made from --help by host/cli/man/man.awk"
    print ".TH " toupper(title) " 1 \"\" \"fibrad " version "\" \"fibrad\""
    print ".ad l\n.nh\n.SH NAME"
    print title " \\- " plain(purpose)
    print ".SH SYNOPSIS"
    if (page == "fibrad") {
        print ".B fibrad\nCOMMAND [options]"
    }
}

# a paragraph ends here
/^$/ {
    if (in_usage) section("DESCRIPTION")
    in_usage = 0
    end_block()
    blank = 1
    next
}

page == "fibrad" && NR == 1 { next }
page != "fibrad" && (NR == 1 || in_usage) {
    command = page
    sub(/-/, " ", command)
    if (in_usage) print ".br"
    in_usage = 1
    print ".B " command "\n" plain(substr($0, length(command) + 2))
    next
}

/^  (-., )?--[a-z]/ {
    if (!in_options) section("OPTIONS")
    in_options = 1
    end = 28
    if (substr($0, 29, 1) != " ") { # wider than the column of heads
        match($0, /^  (-., )?--[^ ]* [^ ]* /)
        end = RLENGTH
    }
    term(names(substr($0, 3, end - 2)), substr($0, end + 2 - (end != 28)))
    blank = 0
    next
}

# The text of an option goes on.
in_options && /^                             [^ ]/ { print plain(substr($0, 30)); next }

/^Examples:$/ { section("EXAMPLES"); in_examples = 1; blank = 0; next }
/^Commands:$/ { section("COMMANDS"); in_commands = 1; blank = 0; next }
/^Exit status: / { section("EXIT STATUS"); print plain(substr($0, 14)); blank = 0; next }

in_commands && /^  / {
    head = $1
    text = substr($0, index($0, head) + length(head))
    sub(/^ +/, "", text)
    term("\\fBfibrad\\-" plain(head) "\\fR(1)", text)
    next
}
in_commands && blank { section("OPTIONS"); in_commands = 0; blank = 0 }
page == "fibrad" && /^fibrad .*  +/ { # `fibrad COMMAND --help   what it prints`
    match($0, /  +/)
    term("\\fB" plain(substr($0, 1, RSTART - 1)) "\\fR", substr($0, RSTART + RLENGTH))
    next
}

in_options { section("NOTES") }
/^ / { begin_block(); print plain(in_examples ? substr($0, 3) : $0); next }
{
    end_block()
    if (blank) print ".PP"
    blank = 0
    print plain($0)
}

END {
    end_block()
    print ".SH SEE ALSO"
    if (page != "fibrad") print ".BR fibrad (1);"
    print "the documentation in share/doc/fibrad"
}
