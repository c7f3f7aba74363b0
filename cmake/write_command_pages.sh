#!/bin/bash
# Writes the manual page and the shells' completions from the output of `sundog --help`:
# write_command_pages.sh SUNDOG FOLDER writes sundog.1, sundog.bash, _sundog (zsh) and sundog.fish to FOLDER.
set -eu
sundog=$1 out=$2
mkdir -p "$out"

# Separates fields. No text contains this character; successive tabs would count as one.
part=$'\x1f'

# Prints the names and descriptions below "Subcommands:".
commands_of() {
  "$sundog" "$@" --help | awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/ { name = $1; $1 = ""; sub(/^ /, ""); print name "\x1f" $0 }'
}
# Prints a line for each option: "-o,--out", "FILE", description.
options_of() {
  "$sundog" "$@" --help | awk '/^Options:/ { on = 1; next } /^[A-Z]/ { on = 0 }
    on && /^  -/ {
      text = substr($0, 3); at = match(text, /  +/); head = at ? substr(text, 1, at - 1) : text
      line = at ? substr(text, at + RLENGTH) : ""
      name = head; sub(/ .*/, "", name); value = ""
      if (index(head, " ")) { value = head; sub(/^[^ ]+ /, "", value); sub(/ REQUIRED$/, "", value) }
      print name "\x1f" value "\x1f" line }'
}

pages=()
while IFS=$part read -r name _; do
  pages+=("$name")
  while IFS=$part read -r inner _; do [[ -z $inner ]] || pages+=("$name $inner"); done < <(commands_of "$name")
done < <(commands_of)

troff() { sed -e 's/\\/\\e/g' -e 's/-/\\-/g' -e "s/^\([.']\)/\\\\\&\1/" <<<"$1"; }

models=$("$sundog" 2>&1 | sed -n 's/.* or a model (\(.*\))$/\1/p')
{
  read -r version < <("$sundog" --version)
  echo ".TH SUNDOG 1 \"\" \"${version}\" \"User Commands\""
  printf '.SH NAME\nsundog \\- OpenCL renderer for meshes, solids, glass and fractals\n.SH SYNOPSIS\n.B sundog\n.I COMMAND\n[\\fIOPTIONS\\fR]\n'
  printf '.SH DESCRIPTION\nRenders scenes (.json) and models (%s) on any OpenCL 1.2 device, and measures devices.\n.SH COMMANDS\n' "$models"
  while IFS=$part read -r name line; do printf '.TP\n.B sundog %s\n%s\n' "$(troff "$name")" "$(troff "$line")"; done < <(commands_of)
  for page in "${pages[@]}"; do
    printf '.SH OPTIONS OF %s\n' "$(troff "${page^^}")"
    # shellcheck disable=SC2086  # a page is one word or two
    while IFS=$part read -r name value line; do
      printf '.TP\n\\fB%s\\fR' "$(troff "$name")"
      [[ -z $value ]] || printf ' \\fI%s\\fR' "$(troff "$value")"
      printf '\n%s\n' "$(troff "$line")"
    done < <(options_of $page)
  done
  printf '.SH EXIT STATUS\n'
  while read -r status line; do printf '.TP\n.B %s\n%s\n' "$status" "$line"; done <<'STATUS'
0 done
1 internal error, or a file could not be read or written
2 the command line is wrong
3 the scene or an input file is bad
4 no such device, or every device failed
5 a kernel did not build
6 compare or check found a difference
130 interrupted; the part rendered so far is saved
STATUS
  printf '.SH ENVIRONMENT\n.TP\n.B SUNDOG_DEVICE\nThe devices to use where no \\-\\-device is given.\n.TP\n.B XDG_CACHE_HOME\nWhere compiled kernels and tuning results are kept, in the folder sundog.\n'
} >"$out/sundog.1"

# Prints a page's options and inner commands as words, for a shell's case.
words_of() {
  # shellcheck disable=SC2086
  { options_of $1 | cut -d "$part" -f1 | tr ',' '\n'; commands_of $1 | cut -d "$part" -f1; } | sort -u | xargs
}

{
  echo '# bash completion for sundog'
  echo '_sundog() {'
  echo '  local word=${COMP_WORDS[COMP_CWORD]} page="" words'
  echo '  [[ $COMP_CWORD -lt 2 ]] || page=${COMP_WORDS[1]}'
  echo '  [[ $page != bench || $COMP_CWORD -lt 3 ]] || page="bench ${COMP_WORDS[2]}"'
  echo '  case $page in'
  printf '    "") words="%s" ;;\n' "$(words_of "")"
  for page in "${pages[@]}"; do printf '    "%s") words="%s" ;;\n' "$page" "$(words_of "$page")"; done
  echo '    *) words="" ;;'
  echo '  esac'
  echo '  COMPREPLY=($(compgen -W "$words" -- "$word"))'
  echo '  [[ -n ${COMPREPLY[0]-} || $word == -* ]] || COMPREPLY=($(compgen -f -- "$word"))'
  echo '}'
  echo 'complete -o filenames -F _sundog sundog'
} >"$out/sundog.bash"

{
  echo '#compdef sundog'
  echo 'local page=""'
  echo '(( CURRENT < 3 )) || page=$words[2]'
  echo '[[ $page != bench ]] || (( CURRENT < 4 )) || page="bench $words[3]"'
  echo 'case $page in'
  printf '  "") compadd -- %s ;;\n' "$(words_of "")"
  for page in "${pages[@]}"; do printf '  "%s") compadd -- %s; _files ;;\n' "$page" "$(words_of "$page")"; done
  echo 'esac'
} >"$out/_sundog"

quote() { sed "s/'/\\\\'/g" <<<"$1"; }
{
  echo '# fish completion for sundog'
  while IFS=$part read -r name line; do
    printf "complete -c sundog -n __fish_use_subcommand -f -a %s -d '%s'\n" "$name" "$(quote "$line")"
  done < <(commands_of)
  for page in "${pages[@]}"; do
    # shellcheck disable=SC2086
    while IFS=$part read -r name value line; do
      printf "complete -c sundog -n '__fish_seen_subcommand_from %s' -l %s" "${page##* }" "${name##*--}"
      [[ $name != -?,* ]] || printf ' -s %s' "${name:1:1}"
      [[ -z $value ]] || printf ' -r'
      printf " -d '%s'\n" "$(quote "$line")"
    done < <(options_of $page)
  done
} >"$out/sundog.fish"
