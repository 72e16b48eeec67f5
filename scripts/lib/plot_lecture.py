#!/usr/bin/python3
"""plot_lecture.py CABLE_SIM OUTPUT_DIRECTORY: measures what doc/lecture.md says, with cable_sim; plots, and a table in measured.md.

About a minute of one core. Energies are per kilogram, v^2/2 - mu/r, from the rows of cable_sim: Verlet's velocity is that of the
positions' time, (r(n+1) - r(n-1)) / 2h.
"""
import math
import pathlib
import sys

import matplotlib
import numpy

from lecture_runs import scene_of, simulate
from markdown_table import table

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

INTEGRATORS = {'verlet': 'Verlet', 'euler': 'Euler', 'rk4': 'RK4', 'pc5': 'PC5'}
LECTURE_START = {'type': 'verlet', 'first_step': 'lecture'}
PERIOD = 2 * math.pi * (2 - 1.1**2)**-1.5  # [s] of the planet, from Kepler's third law
LONG = 100000.0                            # [s]
ORBITS = 100                               # a mean over so many leaves little of where it begins and ends
STEPS = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
STIFFNESSES = (3, 10, 30, 100, 160, 200, 300, 1000)
WAVED = 5.0                                # [s] how long flags are watched
CHAOTIC = 10                               # a link that is longer by so many times its rest length was thrown out by the time step


class Lecture:
    def __init__(self, cable_sim, output):
        self._cable_sim = cable_sim
        self._output = output
        self._facts = []
        self._tables = []

    def run(self, scene, duration, rate=100):
        return simulate(self._cable_sim, scene, duration, rate)

    def planet(self, integrator, time_step, duration, rate):
        return self.run(scene_of('planet', integrator=integrator, time_step=time_step), duration, rate)['planet']

    def measured(self, what, figure, bound):
        self._facts.append((what, figure, bound))

    def tabulated(self, title, header, rows):
        self._tables += ['', f'## {title}', *table(header, rows)]

    def keep(self, figure, name):
        figure.tight_layout()
        # No date and no version inside: the same data make the same bytes.
        figure.savefig(self._output / f'{name}.png', dpi=80, metadata={'Software': None})
        plt.close(figure)

    def write_table(self):
        lines = ['# Measured', '', 'By `scripts/pictures` (`scripts/lib/plot_lecture.py`). Energies are relative to that at the start.', '',
                 *table(('what', 'measured', 'to be'), self._facts), *self._tables]
        (self._output / 'measured.md').write_text('\n'.join(lines) + '\n')


def energy_of(run):
    """[J/kg] of a planet, one a row."""
    return 0.5 * (run.velocities[:, 0]**2).sum(1) - 1 / numpy.linalg.norm(run.positions[:, 0], axis=1)


def energy_error(run):
    energy = energy_of(run)
    return (energy - energy[0]) / abs(energy[0])


def label_energy(*plots):
    for axes in plots:
        axes.set_xlabel('t')
        axes.set_ylabel('(E - E(0)) / |E(0)|')
        axes.legend(fontsize=8)


def plot_energy(lecture):
    figure, (wide, close) = plt.subplots(1, 2, figsize=(9, 3.4))
    for integrator, label in INTEGRATORS.items():
        run = lecture.planet(integrator, 0.01, 100.0, 20)
        wide.plot(run.times, energy_error(run), label=label)
        if integrator != 'euler':
            close.plot(run.times, energy_error(run), label=label)
        else:
            lecture.measured('Planet to t = 100, h = 0.01, Euler: change of energy', f'{energy_error(run)[-1]:+.0%}', '')
    wide.set_title('All four: Euler flies away')
    close.set_title('The others: Verlet stays in a band')
    label_energy(wide, close)
    lecture.keep(figure, 'planet_energy')


def plot_error(lecture):
    reference = lecture.planet('pc5', 1e-4, 2.0, 0.5).positions[-1, 0]
    figure, axes = plt.subplots(figsize=(5.5, 4))
    rows = []
    for integrator, label in {**INTEGRATORS, 'lecture': "Verlet, the lecture's first step"}.items():
        errors = []
        for time_step in STEPS:
            run = lecture.planet(LECTURE_START if integrator == 'lecture' else integrator, time_step, 2.0, 0.5)
            errors.append(float(numpy.linalg.norm(run.positions[-1, 0] - reference)))
        slope = math.log(errors[1] / errors[4]) / math.log(STEPS[1] / STEPS[4])
        axes.loglog(STEPS, errors, 'o-', markersize=4, label=f'{label}: slope {slope:.1f}')
        rows.append((label, *(f'{error:.1e}' for error in errors), f'{slope:.2f}'))
    lecture.tabulated('Error of the planet\'s position at t = 2, against PC5 at h = 1e-4',
                      ('', *(f'h = {time_step:g}' for time_step in STEPS), f'slope from {STEPS[1]:g} to {STEPS[4]:g}'), rows)
    axes.set_xlabel('time step h')
    axes.set_ylabel('error of the position at t = 2')
    axes.legend(fontsize=8)
    axes.grid(alpha=0.3)
    lecture.keep(figure, 'planet_error')


def tenths(run):
    """Mean errors of energy over the first and the last tenth, in whole orbits."""
    error = energy_error(run)
    span = math.floor(0.1 * LONG / PERIOD) * PERIOD
    return error[run.times <= span].mean(), error[run.times > run.times[-1] - span].mean()


def plot_long_run(lecture):
    figure, (wide, close) = plt.subplots(1, 2, figsize=(9, 3.4))
    for integrator in ('verlet', 'rk4', 'pc5'):
        run = lecture.planet(integrator, 0.01, LONG, 2)
        error, (first, last) = energy_error(run), tenths(run)
        subject = f'Planet to t = 1e5, h = 0.01, {INTEGRATORS[integrator]}: '
        if integrator == 'verlet':
            part = (run.times // (ORBITS * PERIOD)).astype(int)
            means = (numpy.bincount(part, error) / numpy.bincount(part))[:-1]
            middles = (numpy.arange(len(means)) + 0.5) * ORBITS * PERIOD
            wide.fill_between((0, LONG), error.min(), error.max(), alpha=0.3, label='Verlet: its whole band')
            wide.plot(middles, means, label=f'Verlet: mean over {ORBITS} orbits')
            close.plot(middles, means - means[0], label='Verlet: change of the mean')
            lecture.measured(subject + 'error of energy', f'{error.min():.2e} to {error.max():.2e}', 'a band')
            lecture.measured(subject + 'change of its mean from the first to the last tenth', f'{last - first:.1e}', 'no drift')
        else:
            for axes in (wide, close):
                axes.plot(run.times, error, label=INTEGRATORS[integrator])
            lecture.measured(subject + 'change of energy', f'{error[-1]:.2e}', 'lost steadily')
            parts = numpy.array_split(error, 10)
            falls = sum(later.mean() < earlier.mean() for earlier, later in zip(parts, parts[1:]))
            lecture.measured(subject + 'tenths with less energy than the one before', f'{falls} of 9', '9 of 9')
    label_energy(wide, close)
    lecture.keep(figure, 'planet_long')


def plot_oscillator(lecture):
    runs = lecture.run(scene_of('oscillator'), 10.0)
    figure, axes = plt.subplots(figsize=(6.5, 3.2))
    for name, damping in (('spring', 0.0), ('damped', 0.5)):
        run, decay = runs[name], damping / 2
        omega = math.sqrt(20 - decay**2)
        exact = numpy.exp(-decay * run.times) * numpy.sin(omega * run.times) / omega
        measured = run.positions[:, 1, 0] - 1
        axes.plot(run.times, measured, label=f'k_d = {damping:g} N s/m')
        axes.plot(run.times[::10], exact[::10], 'k.', markersize=3)
        lecture.measured(f'Oscillator, 10 s, k_d = {damping:g} N s/m: largest difference from the closed form',
                         f'{abs(measured - exact).max():.1e} m', '< 1e-4')
    axes.set_title('Dots: the closed form')
    axes.set_xlabel('t [s]')
    axes.set_ylabel('stretch [m]')
    axes.legend(fontsize=8)
    lecture.keep(figure, 'oscillator_plot')


def plot_ropes(lecture):
    runs = lecture.run(scene_of('ropes'), 10.0)
    figure, axes = plt.subplots(figsize=(6.5, 3.2))
    for name, label in (('soft_rope', 'soft: EA = 40 N'), ('stiff_rope', 'stiff: inextensible')):
        run = runs[name]
        length = numpy.linalg.norm(numpy.diff(run.positions, axis=1), axis=2).sum(1)
        axes.plot(run.times, length, label=label)
        lecture.measured(f'Rope of 1 m with 1 kg, swinging 10 s, {label}: length', f'{length.min():.4f} to {length.max():.4f} m', '')
    axes.set_xlabel('t [s]')
    axes.set_ylabel('length [m]')
    axes.legend(fontsize=8)
    lecture.keep(figure, 'ropes_plot')


def waved(lecture, name, stiffness):
    """Largest |l / l0 - 1|, and the mean kinetic energy [J] of the second half."""
    scene = scene_of(name)
    scene['nets'][0]['stiffness'] = stiffness
    run = lecture.run(scene, WAVED)['flag']
    nodes = run.positions.shape[1]
    kinetic = 0.5 * scene['nets'][0]['mass'] / nodes * (run.velocities**2).sum((1, 2))
    return run.summary['max_strain'], kinetic[len(kinetic) // 2:].mean()


def chaotic_stiffness(lecture, calm, chaotic):
    """[N/m] Between a stiffness that is calm and one that is not, to 1 N/m."""
    while chaotic - calm > 1:
        middle = (calm + chaotic) // 2
        if waved(lecture, 'elastic_flag', middle)[0] > CHAOTIC:
            chaotic = middle
        else:
            calm = middle
    return chaotic


def plot_flags(lecture):
    figure, axes = plt.subplots(figsize=(6.5, 3.6))
    rows = []
    for name, label in (('elastic_flag', 'elastic'), ('semi_rigid_flag', 'semi-rigid')):
        flags = [waved(lecture, name, stiffness) for stiffness in STIFFNESSES]
        strains = [strain for strain, _ in flags]
        rows.append((f'{label}: largest stretch', *('thrown out' if strain > CHAOTIC else f'{strain:.1%}' for strain in strains)))
        rows.append((f'{label}: kinetic energy', *('' if strain > CHAOTIC else f'{kinetic:.3f} J' for strain, kinetic in flags)))
        axes.loglog(STIFFNESSES, [min(strain, CHAOTIC) for strain in strains], 'o-', label=label)
        if label == 'elastic':
            calm = max(s for s, strain in zip(STIFFNESSES, strains) if strain <= CHAOTIC)
            chaotic = min(s for s, strain in zip(STIFFNESSES, strains) if strain > CHAOTIC)
    lecture.tabulated(f'Flags in wind, {WAVED:g} s at 1 ms; semi-rigid: to be within 10 %',
                      ('', *(f'{stiffness} N/m' for stiffness in STIFFNESSES)), rows)
    limit = chaotic_stiffness(lecture, calm, chaotic)
    lecture.measured('Flag, elastic: the stiffness from which on 1 ms is chaotic', f'{limit} N/m', '')
    axes.axvline(limit, color='k', linestyle=':', linewidth=1, label=f'{limit} N/m: chaotic from here on')
    axes.axhline(0.1, color='k', linewidth=0.5)
    axes.set_xlabel('stiffness of the links [N/m]')
    axes.set_ylabel('largest |l / l0 - 1|; 10: thrown out')
    axes.legend(fontsize=8)
    lecture.keep(figure, 'flags_plot')


def momentum_lost(lecture, scene, net, duration):
    """What changes of the horizontal momentum while a net falls freely, spinning, after it bounced off a ball: of its largest."""
    ball = {'name': 'ball', 'type': 'sphere', 'radius': 0.3, 'pose': [0.2, 0.1, 2, 0, 0, 0], 'friction': 0}
    scene.update(obstacles=[ball], fluid={'density': 0})
    run = lecture.run(scene, duration)[net]
    free = run.positions[:, :, 2].max(1) < 1.7
    momentum = run.velocities[free].mean(1)[:, :2]
    if free.sum() < 20:
        sys.exit(f'plot_lecture.py: the {net} does not pass the ball within {duration} s')
    return numpy.linalg.norm(momentum - momentum[0], axis=1).max() / numpy.linalg.norm(momentum[0])


def measure_figure(lecture):
    run = lecture.run(scene_of('figure_on_stairs'), 10.0)['figure']
    lecture.measured('Stick figure thrown down the stairs, 10 s: largest strain of a stick', f'{run.summary["max_strain"]:.1e}',
                     '< 1e-3')
    lost = momentum_lost(lecture, scene_of('figure_on_stairs'), 'figure', 2.5)
    lecture.measured('Rigid: change of momentum while the figure, bounced off a ball, falls freely', f'{lost:.0e}', '0')
    flag = scene_of('semi_rigid_flag')
    flag['nets'][0].update(attachments=[], velocity=[0, 0, 0])
    flag['nets'][0]['grid'].update(origin=[-0.2, -0.2, 2.6], y_axis=[0, 1, 0])
    lost = momentum_lost(lecture, flag, 'flag', 4.0)
    lecture.measured('Limited: change of momentum while a flag, slipped off a ball, falls freely', f'{lost:.0e}', '0')


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    lecture = Lecture(sys.argv[1], pathlib.Path(sys.argv[2]))
    pathlib.Path(sys.argv[2]).mkdir(parents=True, exist_ok=True)
    for subject in (plot_energy, plot_error, plot_long_run, plot_oscillator, plot_ropes, plot_flags, measure_figure):
        subject(lecture)
    lecture.write_table()


if __name__ == '__main__':
    main()
