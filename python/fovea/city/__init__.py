"""`python3 -m fovea.city`: plans and runs the jobs that make one city map from many drives (docs/city.md).

A job is one command that reads files and writes one file. The name of the file is a hash of the job's inputs, so a
job is done if its file exists. Dask Distributed runs the jobs; `plan` writes them for any other engine.
"""
