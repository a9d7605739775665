#!/usr/bin/env python3
"""Makes manual pages and completions (bash, zsh, fish) of talus, from what the program says of itself.

    make_manual.py --program build/release/talus --out FOLDER

Names, types, bounds and texts are those of `talus help --json`; examples, those of `talus COMMAND --help`. FOLDER gets
man1/talus.1, man1/talus-COMMAND.1, bash/talus, zsh/_talus and fish/talus.fish. The date of the pages is that of
SOURCE_DATE_EPOCH where it is set.
"""
import argparse
import datetime
import json
import os
import pathlib
import shutil
import subprocess

PLACEHOLDERS = {"file": "FILE", "folder": "FOLDER", "integer": "N", "number": "NUMBER", "text": "TEXT"}


def answer_of(program, *words):
    """What the program prints."""
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def named(parameter):
    return not parameter["positional"]


def takes_value(parameter):
    return parameter["type"] != "flag"


def kind_of(parameter):
    """The type of one value of it."""
    return parameter.get("of", parameter["type"])


def few_choices(parameter):
    return len(parameter.get("choices", ())) in range(1, 5)


def placeholder(parameter):
    """What stands for the value: N, FILE, {a,b}."""
    if few_choices(parameter):
        return "{" + ",".join(parameter["choices"]) + "}"
    word = PLACEHOLDERS.get(kind_of(parameter), "NAME")
    return f"{word}{parameter['delimiter']}..." if parameter["type"] == "list" else word


def bounds_text(parameter):
    """'1 to 4096', 'above 0'; empty without bounds."""
    bounds = parameter["bounds"]
    low, high = bounds.get("low"), bounds.get("high")
    if low is None:
        return ""
    if high is None:
        return f"above {low}" if bounds.get("low_excluded") else f"{low} or more"
    excluded = [value for value, name in ((low, "low_excluded"), (high, "high_excluded")) if bounds.get(name)]
    return f"{low} to {high}" + (f", without {' and '.join(map(str, excluded))}" if excluded else "")


def remarks_of(parameter):
    """Unit, bounds, default and the like, where the text does not say them."""
    text, remarks = parameter["text"], []
    if parameter["unit"] and f"[{parameter['unit']}]" not in text:
        remarks.append(f"Unit: {parameter['unit']}.")
    if "choices" in parameter and not few_choices(parameter):
        remarks.append(f"One of {', '.join(parameter['choices'])}.")
    if bounds_text(parameter):
        remarks.append(f"Allowed: {bounds_text(parameter)}.")
    default = parameter["default"]
    if takes_value(parameter) and default is not None and str(default) not in ("", *text.replace("(", " ").replace(")", " ").split()):
        remarks.append(f"Default: {default}.")
    if parameter["required"]:
        remarks.append("Required.")
    if parameter["repeatable"] and "repeated" not in text:
        remarks.append("May be repeated.")
    return remarks


# Manual pages


def roff(text):
    """Text as roff shows it."""
    lines = text.replace("\\", "\\e").replace("-", "\\-").split("\n")
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in lines)


def heading(name, title, version):
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", datetime.datetime.now().timestamp()))
    date = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%d")
    return f'.TH {name.upper()} 1 {date} "Talus {version}" "Talus"\n.nh\n.ad l\n.SH NAME\n{roff(name)} \\- {roff(title)}\n'


def with_full_stop(text):
    return text if text.endswith((".", ":")) else text + "."


def roff_entry(parameter):
    """The entry of one parameter in its page."""
    value = f"\\fI{roff(placeholder(parameter))}\\fR" if takes_value(parameter) else ""
    if named(parameter):
        flags = ", ".join(f"\\fB{roff(flag)}\\fR" for flag in parameter["flags"])
        tag = f"{flags} {value}".rstrip()
    else:
        tag = f"\\fI{roff(parameter['name'])}\\fR"
    text = " ".join([with_full_stop(parameter["text"]), *remarks_of(parameter)])
    return f".TP\n{tag}\n{roff(text)}\n"


def synopsis(command):
    """The words of a call: what must be given, [what may]."""
    words = [f"\\fBtalus {roff(command['name'])}\\fR"]
    for parameter in command["parameters"]:
        if not named(parameter):
            name = f"\\fI{roff(parameter['name'])}\\fR" + ("..." if parameter["repeatable"] else "")
        elif parameter["required"]:
            name = f"\\fB{roff(parameter['flags'][-1])}\\fR \\fI{roff(placeholder(parameter))}\\fR"
        else:
            continue
        words.append(name if parameter["required"] else f"[{name}]")
    return " ".join(words + ["[options]"])


def examples_of(program, command):
    """What the help of the command says from its examples on."""
    _, found, rest = answer_of(program, command["name"], "--help").partition("\nExample")
    if not found:
        return ""
    calls, _, notes = rest.split("\n", 1)[1].partition("\n\n")
    page = f".SH EXAMPLES\n.nf\n{roff(calls.rstrip())}\n.fi\n"
    return page + (f".SH NOTES\n{roff(notes.strip())}\n" if notes.strip() else "")


def command_page(program, command, version):
    positional = [p for p in command["parameters"] if not named(p)]
    options = [p for p in command["parameters"] if named(p)]
    page = heading("talus-" + command["name"], command["text"], version)
    page += f".SH SYNOPSIS\n{synopsis(command)}\n.SH DESCRIPTION\n{roff(with_full_stop(command['text']))}\n"
    page += "".join(map(roff_entry, positional))
    if options:
        page += ".SH OPTIONS\n" + "".join(map(roff_entry, options))
    return page + examples_of(program, command) + exit_status() + ".SH SEE ALSO\n.BR talus (1)\n"


def exit_status():
    codes = (("0", "done"), ("2", "the input is wrong; one line says where and what"), ("130", "interrupted"),
             ("1", "anything else"))
    return ".SH EXIT STATUS\n" + "".join(f".TP\n.B {code}\n{text}\n" for code, text in codes)


def main_page(description):
    page = heading("talus", "rock-fall hazard on 3D terrain", description["version"])
    page += ".SH SYNOPSIS\n\\fBtalus\\fR \\fICOMMAND\\fR [options]\n"
    page += f".SH DESCRIPTION\n{roff(with_full_stop(description['text']))}\n.SH COMMANDS\n"
    for command in description["commands"]:
        page += f".TP\n\\fB{roff(command['name'])}\\fR\n{roff(with_full_stop(command['text']))}\n"
    page += exit_status() + ".SH FILES\n.TP\n.I /usr/share/doc/talus\nThe manual.\n"
    page += ".TP\n.I /usr/share/doc/talus/examples/valley\nAn example: copy it, then\n"
    page += ".B talus run scenario.toml \\-o out\n.SH SEE ALSO\n"
    return page + ",\n".join(f".BR talus\\-{command['name']} (1)" for command in description["commands"]) + "\n"


# Completions


def long_flags(command):
    return [flag for p in command["parameters"] for flag in p["flags"]] + ["--help"]


def bash_values(parameter):
    """The bash command that completes the value of a parameter; empty if there is none."""
    if "choices" in parameter:
        return f'COMPREPLY=($(compgen -W "{" ".join(parameter["choices"])}" -- "$current"))'
    return {"file": "compopt -o filenames; COMPREPLY=($(compgen -f -- \"$current\"))",
            "folder": "compopt -o filenames; COMPREPLY=($(compgen -d -- \"$current\"))"}.get(kind_of(parameter), ":")


def bash_command(command, names):
    lines = [f"    {command['name']})", '      case "$previous" in']
    lines += [f"        {'|'.join(p['flags'])}) {bash_values(p)}; return ;;"
              for p in command["parameters"] if named(p) and takes_value(p)]
    lines += ["      esac",
              f'      [[ $current == -* ]] && {{ COMPREPLY=($(compgen -W "{" ".join(long_flags(command))}" -- "$current")); return; }}']
    positional = [p for p in command["parameters"] if not named(p)]
    if command["name"] == "help":
        lines.append(f'      COMPREPLY=($(compgen -W "{names}" -- "$current"))')
    elif positional:
        lines.append(f"      {bash_values(positional[0])}")
    return "\n".join(lines + ["      ;;"])


def bash_completion(commands):
    names = " ".join(command["name"] for command in commands)
    cases = "\n".join(bash_command(command, names) for command in commands)
    return f"""# bash completion of talus, made from `talus help --json`
_talus() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  COMPREPLY=()
  if [[ $COMP_CWORD -eq 1 ]]; then
    COMPREPLY=($(compgen -W "{names} --help --version" -- "$current"))
    return
  fi
  case "${{COMP_WORDS[1]}}" in
{cases}
  esac
}}
complete -F _talus talus
"""


def zsh_text(text):
    """Text within a specification of _arguments, in single quotes."""
    for sign in "\\[]:":
        text = text.replace(sign, "\\" + sign)
    return text.replace("'", "'\\''")


def zsh_values(parameter):
    """':name:action' of a value."""
    if "choices" in parameter:
        return f":{parameter['name']}:({' '.join(parameter['choices'])})"
    action = {"file": "_files", "folder": "_files -/"}.get(kind_of(parameter), "")
    return f":{parameter['name']}:{action}"


def zsh_option(parameter):
    flags = parameter["flags"]
    value = zsh_values(parameter) if takes_value(parameter) else ""
    many = "'*'" if parameter["repeatable"] else f"'({' '.join(flags)})'"
    names = "{" + ",".join(flags) + "}" if len(flags) > 1 else f"'{flags[0]}'"
    return f"{many}{names}'[{zsh_text(parameter['text'])}]{value}'"


def zsh_command(command):
    options = [zsh_option(p) for p in command["parameters"] if named(p)] + ["'--help[print the help]'"]
    options += [f"'{'*' if p['repeatable'] else ''}{zsh_values(p)}'" for p in command["parameters"] if not named(p)]
    return f"    {command['name']})\n      _arguments -s \\\n        " + " \\\n        ".join(options) + "\n      ;;"


def zsh_completion(commands):
    names = "\n".join(f"    '{command['name']}:{zsh_text(command['text'])}'" for command in commands)
    cases = "\n".join(map(zsh_command, commands))
    return f"""#compdef talus
# zsh completion of talus, made from `talus help --json`
_talus() {{
  local -a commands=(
{names}
  )
  if (( CURRENT == 2 )); then
    _describe command commands
    _arguments '--help[print the help]' '--version[print the version]'
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{cases}
  esac
}}
_talus "$@"
"""


def fish_text(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def fish_values(parameter):
    if not takes_value(parameter):
        return ""
    if "choices" in parameter:
        return f" -x -a '{' '.join(parameter['choices'])}'"
    return {"file": " -r -F", "folder": " -x -a '(__fish_complete_directories)'"}.get(kind_of(parameter), " -x")


def fish_option(command, parameter):
    names = " ".join(f"-l {flag[2:]}" if flag.startswith("--") else f"-s {flag[1:]}" for flag in parameter["flags"])
    condition = f"-n '__fish_seen_subcommand_from {command['name']}'"
    return f"complete -c talus {condition} {names}{fish_values(parameter)} -d {fish_text(parameter['text'])}"


def fish_command(command):
    lines = [f"complete -c talus -n __fish_use_subcommand -a {command['name']} -d {fish_text(command['text'])}"]
    lines += [fish_option(command, p) for p in command["parameters"] if named(p)]
    if any(kind_of(p) in ("file", "folder") for p in command["parameters"] if not named(p)):
        lines.append(f"complete -c talus -n '__fish_seen_subcommand_from {command['name']}' -F")
    return "\n".join(lines)


def fish_completion(commands):
    begin = ["# fish completion of talus, made from `talus help --json`", "complete -c talus -f",
             "complete -c talus -l help -d 'print the help'",
             "complete -c talus -n __fish_use_subcommand -l version -d 'print the version'"]
    return "\n".join(begin + list(map(fish_command, commands))) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="the program talus")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to make; replaced if it is there")
    options = parser.parse_args()
    description = json.loads(answer_of(options.program, "help", "--json"))
    commands = description["commands"]
    shutil.rmtree(options.out, ignore_errors=True)
    for folder in ("man1", "bash", "zsh", "fish"):
        (options.out / folder).mkdir(parents=True)
    (options.out / "man1" / "talus.1").write_text(main_page(description), encoding="utf-8")
    for command in commands:
        page = command_page(options.program, command, description["version"])
        (options.out / "man1" / f"talus-{command['name']}.1").write_text(page, encoding="utf-8")
    (options.out / "bash" / "talus").write_text(bash_completion(commands), encoding="utf-8")
    (options.out / "zsh" / "_talus").write_text(zsh_completion(commands), encoding="utf-8")
    (options.out / "fish" / "talus.fish").write_text(fish_completion(commands), encoding="utf-8")


if __name__ == "__main__":
    main()
