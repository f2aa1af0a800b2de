# filled by the install slice
