# SPDX-License-Identifier: Apache-2.0
"""Client of RPSUP, the service for parameter studies of spatial linkages.

    import rpsup
    with rpsup.start() as client:                    # or rpsup.Client("http://127.0.0.1:8080")
        sweep = client.submit(clearance_mm=[0, 0.25], coupler=["rigid", "flexible"])
        table = sweep.wait().results()               # a DataFrame, a row a job
        run = client.trajectory(table.job_id[0], ["slider_acceleration_m_s2"])

Every number is in the unit that ends its name, as in `clearance_mm`. Only the standard library is needed.
With NumPy trajectories are arrays, and with pandas tables are DataFrames.
"""

from .client import Client, Service, start
from .errors import BadAnswer, Error, Fault, ProgramError, Unreachable
from .study import Fit, Job, Measurement, Optimisation, Search, Study, WearStudy
from .sweep import Sweep
from .version import VERSION as __version__

__all__ = ["BadAnswer", "Client", "Error", "Fault", "Fit", "Job", "Measurement", "Optimisation",
           "ProgramError", "Search", "Service", "Study", "Sweep", "Unreachable", "WearStudy",
           "__version__", "start"]
