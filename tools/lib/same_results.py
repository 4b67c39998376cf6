"""Comparison of two results files, bit by bit: all groups, datasets and attributes but the computing times."""

import h5py
import numpy as np

TIMES = {'wall_seconds'}
# Object references: addresses in the file.
REFERENCES = {'DIMENSION_LIST', 'REFERENCE_LIST'}


def differences(a, b):
    """Paths at which two HDF5 files differ; wall times may."""
    found = []
    with h5py.File(a, 'r') as first, h5py.File(b, 'r') as second:
        compare(first, second, '', found)
    return found


def compare(a, b, at, found):
    if set(a.attrs) != set(b.attrs):
        found.append(f'{at}@')
    for name in (set(a.attrs) & set(b.attrs)) - REFERENCES:
        if not same(np.asarray(a.attrs[name]), np.asarray(b.attrs[name])):
            found.append(f'{at}@{name}')
    if isinstance(a, h5py.Dataset) or isinstance(b, h5py.Dataset):
        if type(a) is not type(b) or not same(a[()], b[()]):
            found.append(at)
        return
    if set(a) != set(b):
        found.append(f'{at}/ (members)')
    for name in (set(a) & set(b)) - TIMES:
        compare(a[name], b[name], f'{at}/{name}', found)


def same(a, b):
    """True for arrays of the same bits; NaNs of the same bits are the same."""
    a, b = np.asarray(a), np.asarray(b)
    if a.dtype != b.dtype or a.shape != b.shape:
        return False
    if a.dtype.hasobject:
        return all(same(x, y) if isinstance(x, np.ndarray) else x == y for x, y in zip(a.ravel(), b.ravel())) \
            if a.dtype.names is None else all(same(a[n], b[n]) for n in a.dtype.names)
    return a.tobytes() == b.tobytes()
