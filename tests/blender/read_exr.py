"""Writes an EXR file's channels beside it as .npz, and its metadata as .json."""

import json
import sys
from pathlib import Path

import numpy as np
import OpenEXR

path = Path(sys.argv[1])
channels, metadata = {}, {}
with OpenEXR.File(str(path), separate_channels=True) as file:
    for part in file.parts:
        for name, channel in part.channels.items():
            channels[name] = np.ascontiguousarray(channel.pixels[::-1].astype(np.float32))
        metadata.update({k: v for k, v in part.header.items() if isinstance(v, str)})
np.savez(path.with_suffix(".npz"), **channels)
path.with_suffix(".json").write_text(json.dumps(metadata))
