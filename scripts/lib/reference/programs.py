"""doc/reference/command_lines.md from what the programs answer to --help, and the arguments of the launch files."""
import os
import subprocess
import xml.etree.ElementTree

from reference.markdown import anchor, fence, generated, table

BUILT = ['cable_sim', 'cable_fit']
INSTALLED = ['cable_coco', 'cable_convert', 'cable_sweep', 'record_coco', 'record_to_csv', 'clouds_to_csv', 'play_motion.py']
OF_CHECKOUT = ['demo', 'test', 'bench', 'audit', 'sweep', 'pictures', 'docs', 'real', 'fuzz', 'sanitize', 'soak']


def help_of(program):
    environment = dict(os.environ, COLUMNS='110', LC_ALL='C.UTF-8')
    done = subprocess.run([str(program), '--help'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, check=True)
    return done.stdout


def program_section(path, how):
    return f'### {path.name}\n\n`{how} {path.name}`\n\n' + fence(help_of(path), 'text')


def script_section(path):
    """What a script of the checkout says of itself, and its options if it has any."""
    text = path.read_text(encoding='utf-8')
    comment = ' '.join(line.lstrip('# ') for line in text.partition('\n\n')[0].splitlines()[1:])
    return f'### scripts/{path.name}\n\n{comment}\n\n' + (fence(help_of(path), 'text') if '\nusage() {' in text else '')


def launch_rows(path):
    for argument in xml.etree.ElementTree.parse(path).getroot().findall('arg'):
        if 'value' not in argument.attrib:
            default = argument.get('default')
            yield [anchor(f'{path.stem}-{argument.get("name")}') + f'`{argument.get("name")}`', 'required' if default is None else f'`{default}`', argument.get('doc', '')]


def launch_sections(checkout):
    text = ''
    for path in sorted((checkout / 'launch').glob('*.launch')):
        rows = list(launch_rows(path))
        text += f'### {path.name}\n\n[{path.name}](../../launch/{path.name})\n\n' + table(['argument', 'default', ''], rows)
    return text


def page(checkout, built):
    text = generated('Command lines', 'what the programs print, and launch') + '## Programs\n\n'
    text += ''.join(program_section(built / name, 'rosrun verlet_cable') for name in BUILT)
    text += ''.join(program_section(checkout / 'scripts' / name, 'rosrun verlet_cable') for name in INSTALLED)
    text += '## Scripts of the checkout\n\n' + ''.join(script_section(checkout / 'scripts' / name) for name in OF_CHECKOUT)
    return text + '## Launch files\n\n`roslaunch verlet_cable FILE argument:=value`\n\n' + launch_sections(checkout)
