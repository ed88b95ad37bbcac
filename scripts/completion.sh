#!/bin/sh
# Make bash completion from the programs' own --help: completion.sh RELUME RELUME_VIEW > relume
set -eu
relume=$1 viewer=$2

# "  --bits B   8, 16 or half; default: 8" becomes "--bits B 8 16 half": name, argument, and the
# values when the text begins with a list of words.
options() {
    awk '/^options:/ { inside = 1; next }
    NF == 0 { inside = 0 }
    inside && /^  / && !seen[$1]++ {
        text = $0
        sub(/^ +[^ ]+/, "", text)
        argument = $2
        takes = substr(text, 1, 2) != "  " && argument ~ /^([A-Z]|x,y,z|z\|y)/
        sub(/^ [^ ]+/, "", text)
        sub(/;.*/, "", text)
        gsub(/ \([^)]*\)/, "", text)
        n = split(text, part, / *, *| +or +/)
        values = ""
        for (i = 1; takes && argument != "N" && n > 1 && i <= n; i++) {
            sub(/^ +/, "", part[i])
            if (part[i] ~ /^[a-z0-9]+$/) values = values " " part[i]
            else if (part[i] !~ /^[a-z]+:[A-Z]$/) { values = ""; break }
        }
        print $1, (takes ? argument : "-") values
    }'
}
# One case per option that takes a value.
cases() {
    while read -r name argument values; do
        case $argument in
        -) ;;
        DIR) echo "        $1$name) COMPREPLY=(\$(compgen -d -- \"\$word\")); return ;;" ;;
        FILE* | OUT* | EVENTS)
            echo "        $1$name) COMPREPLY=(\$(compgen -f -- \"\$word\")); return ;;" ;;
        *) echo "        $1$name) COMPREPLY=(\$(compgen -W \"$values\" -- \"\$word\")); return ;;" ;;
        esac
    done
}
names() { awk '{ printf "%s%s", (NR > 1 ? " " : ""), $1 }'; }

# What follows the name of a command and, where it has tasks, their names.
tasks() { "$relume" "$1" --help | sed -n '/^tasks;/,/^$/s/^  \([a-z]*\) .*/\1/p'; }
helps() {
    "$relume" "$1" --help
    for t in $(tasks "$1"); do "$relume" "$1" "$t" --help; done
}

commands=$("$relume" --help | sed -n 's/^  \([a-z]*\) .*/\1/p' | tr '\n' ' ')
scenes=$("$relume" synth --help | sed -n 's/^render a built-in scene (\([^)]*\)).*/\1/p' | tr -d ,)

echo "# bash completion for relume and relume-view, made from their --help"
echo "_relume()"
echo "{"
echo "    local word=\${COMP_WORDS[COMP_CWORD]} last=\${COMP_WORDS[COMP_CWORD-1]}"
echo "    local command=\${COMP_WORDS[1]} words="
echo "    if [ \"\$COMP_CWORD\" = 1 ]; then"
echo "        COMPREPLY=(\$(compgen -W \"$commands--help --version\" -- \"\$word\"))"
echo "        return"
echo "    fi"
echo "    case \$command:\$last in"
for c in $commands; do helps "$c" | options | cases "$c:"; done
for c in $commands; do
    words=$(tasks "$c" | tr '\n' ' ')
    # a command that runs by itself takes files as well
    case $("$relume" "$c" --help | sed -n 1p) in *' -o '*) files='-f ' ;; *) files= ;; esac
    [ -z "$words" ] || echo "        $c:$c) COMPREPLY=(\$(compgen ${files}-W \"$words\" -- \"\$word\")); return ;;"
done
echo "        synth:synth) COMPREPLY=(\$(compgen -W \"$scenes\" -- \"\$word\")); return ;;"
echo "    esac"
echo "    case \$command in"
for c in $commands; do
    echo "        $c) words=\"$(helps "$c" | options | names)\" ;;"
done
echo "    esac"
echo "    case \$word in"
echo "        -*) COMPREPLY=(\$(compgen -W \"\$words\" -- \"\$word\")) ;;"
echo "        *) COMPREPLY=(\$(compgen -f -- \"\$word\")) ;;"
echo "    esac"
echo "}"
echo "_relume_view()"
echo "{"
echo "    local word=\${COMP_WORDS[COMP_CWORD]} last=\${COMP_WORDS[COMP_CWORD-1]}"
echo "    case \$last in"
"$viewer" --help | options | cases ""
echo "    esac"
echo "    case \$word in"
echo "        -*) COMPREPLY=(\$(compgen -W \"$("$viewer" --help | options | names)\" -- \"\$word\")) ;;"
echo "        *) COMPREPLY=(\$(compgen -f -- \"\$word\")) ;;"
echo "    esac"
echo "}"
echo "complete -o filenames -F _relume relume"
echo "complete -o filenames -F _relume_view relume-view"
