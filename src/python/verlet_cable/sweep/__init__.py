"""cable_sweep: many variations of a scene, simulated with Dask and kept in one Zarr store.

description.py reads SWEEP.yaml; variations.py draws what a sample is; layout.py and store.py are the store; simulation.py and worker.py
are what is done for a chunk of samples, in a worker; schedule.py has Dask do it for all of them; command.py is the program.
Needs Debian's python3-dask, python3-distributed and python3-zarr.
"""
