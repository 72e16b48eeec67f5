"""What a soak has come to: as text, as JSON, and the memory over time as a picture."""
import json

import numpy as np


def latency(seconds):
    return {'p50': round(float(np.percentile(seconds, 50)), 4), 'p99': round(float(np.percentile(seconds, 99)), 4),
            'max': round(max(seconds), 4), 'count': len(seconds)}


def memory(record):
    times, sizes = np.array(record.samples).reshape(-1, 2).T
    settled = record.settled()[1]
    result = {'start_MB': sizes[0], 'end_MB': sizes[-1], 'largest_MB': max(sizes)}
    if len(settled):
        result['settled_MB'] = settled[0]
    fit = record.fit()
    if fit:
        result.update(growth_MB_per_hour=3600 * fit[0], spread_MB=fit[1])
    return {key: round(float(value), 1) for key, value in result.items()}


def summarize(seconds, seed, build, findings, calls, watch, records, others):
    return {
        'hours': round(seconds / 3600, 3), 'seed': seed, 'build': build,
        'findings': {kind: count for kind, (count, _) in findings.all.items()},
        'examples': {kind: str(example)[:2000] for kind, (_, example) in findings.all.items()},
        'calls': {name: {'done': calls.answered.get(name, 0), 'refused': calls.refused.get(name, 0), 'closed': calls.closed.get(name, 0),
                         'without_master': calls.without_master.get(name, 0)}
                  for name in sorted({**calls.answered, **calls.refused, **calls.closed, **calls.without_master})},
        'latency_s': {name: latency(values) for name, values in sorted(calls.latencies.items())},
        'steps': watch.steps, 'messages_checked': watch.messages, 'events': watch.events,
        'memory': {record.name: memory(record) for record in records if record.samples}, **others}


def text(summary):
    lines = [f'{summary["hours"]:.2f} h, {summary["build"]}, seed {summary["seed"]}: {summary["steps"]} steps, '
             f'{sum(summary["messages_checked"].values())} messages checked',
             f'{"service":15}{"done":>8}{"refused":>9}{"closed":>8}{"no master":>11}{"p50 [s]":>10}{"p99 [s]":>10}{"max [s]":>10}']
    for name, counts in summary['calls'].items():
        times = summary['latency_s'].get(name, {})
        lines.append(f'{name:15}{counts["done"]:8}{counts["refused"]:9}{counts["closed"]:8}{counts["without_master"]:11}' +
                     ''.join(f'{times[key]:10.3f}' if key in times else f'{"":10}' for key in ('p50', 'p99', 'max')))
    for key in ('sent', 'clients', 'frames', 'events'):
        lines.append(f'{key}: ' + ', '.join(f'{name} {value}' for name, value in summary[key].items()))
    for key, sizes in summary['memory'].items():
        lines.append(f'memory, {key}: ' + ', '.join(f'{name} {value}' for name, value in sizes.items()))
    for kind, count in summary['findings'].items():
        lines.append(f'FOUND {count} times: {kind}: {summary["examples"][kind][:300]}')
    return '\n'.join(lines)


def draw(records, build, path):
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(8, 3.5))
    for record in records:
        times, sizes = np.array(record.samples).reshape(-1, 2).T
        axes.plot(times / 60, sizes, linewidth=1, label=f'{record.name}, {build}')
        fit = record.fit()
        if fit:
            times, sizes = record.settled()
            line = np.median(sizes - fit[0] * times) + fit[0] * times
            axes.plot(times / 60, line, label=f'from the {record.SETTLING / 60:.0f}th minute on: {3600 * fit[0]:+.1f} MB an hour')
    axes.axvspan(0, min(times[-1], record.SETTLING) / 60, color='0.92', label='fills up')
    axes.set_xlabel('time [min]')
    axes.set_ylabel('memory of the node [MB]')
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.legend(loc='lower left', bbox_to_anchor=(0, 1), ncol=3, frameon=False, fontsize='small')
    figure.tight_layout()
    figure.savefig(path, dpi=80, metadata={'Software': None})


def write(summary, records, directory):
    (directory / 'summary.json').write_text(json.dumps(summary, indent=2) + '\n')
    (directory / 'summary.txt').write_text(text(summary) + '\n')
    records = [record for record in records if record.samples]
    (directory / 'memory.csv').write_text('s,of,MB\n' + ''.join(
        f'{time:.1f},{record.name},{size:.2f}\n' for record in records for time, size in record.samples))
    draw(records, summary['build'], directory / 'memory.png')
