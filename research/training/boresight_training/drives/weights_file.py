"""Weights of motion networks as one compact file, version 1, little-endian.

    8 bytes   BORESMOT
    u32       version
    u32       tensors
    each      u8 length of its name, the name, u8 numbers: 0 of 32 bits, 1 of 16; u8 axes, u32 length of each axis,
              then the numbers in row-major order
    u32       CRC-32 (ISO 3309) of all bytes before

Tensors have the names and shapes that PyTorch has them by, `[outputs, inputs]` of layers, sorted by name.
"""

import hashlib
import struct
import zlib
from pathlib import Path

import numpy as np
import torch

MAGIC, VERSION = b"BORESMOT", 1
NUMBERS = (np.dtype("<f4"), np.dtype("<f2"))


def encoded(tensors: dict[str, torch.Tensor], half_from: int | None) -> bytes:
    """The file's bytes; tensors of `half_from` numbers and more have 16 bits each."""
    parts = [MAGIC, struct.pack("<II", VERSION, len(tensors))]
    for name in sorted(tensors):
        values = tensors[name].detach().cpu().numpy()
        kind = int(half_from is not None and values.size >= half_from)
        raw = name.encode()
        parts.append(struct.pack("<B", len(raw)) + raw + struct.pack("<BB", kind, values.ndim))
        parts.append(struct.pack(f"<{values.ndim}I", *values.shape) + values.astype(NUMBERS[kind]).tobytes())
    body = b"".join(parts)
    return body + struct.pack("<I", zlib.crc32(body))


def write(path: Path, tensors: dict[str, torch.Tensor], half_from: int | None = None) -> int:
    """Writes the file and returns its bytes."""
    return Path(path).write_bytes(encoded(tensors, half_from))


def write_beside(path: Path, tensors: dict[str, torch.Tensor], half_from: int | None) -> dict:
    """Writes the file beside an ONNX file, under its name, and returns what its card says of it."""
    path = Path(path).with_suffix(".bin")
    size = write(path, tensors, half_from)
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return {"weights": {"file": path.name, "version": VERSION, "bytes": size, "sha256": digest}}


def read(path: Path) -> dict[str, torch.Tensor]:
    """The tensors of a file, in single precision.

    Raises `ValueError` for a file that is none, is damaged, of another version, or holds what is not finite.
    """
    data = Path(path).read_bytes()
    if len(data) < 20 or data[:8] != MAGIC:
        raise ValueError(f"{path} is no file of weights: expected {MAGIC.decode()}")
    if struct.unpack("<I", data[-4:])[0] != zlib.crc32(data[:-4]):
        raise ValueError(f"{path} is damaged: its check sum is another")
    version, count = struct.unpack_from("<II", data, 8)
    if version != VERSION:
        raise ValueError(f"{path} is version {version}: expected {VERSION}")
    tensors, at = {}, 16
    for _ in range(count):
        length = data[at]
        name = data[at + 1 : at + 1 + length].decode()
        kind, axes = struct.unpack_from("<BB", data, at + 1 + length)
        at += 3 + length
        shape = struct.unpack_from(f"<{axes}I", data, at)
        at += 4 * axes
        size = int(np.prod(shape, dtype=np.int64))
        values = np.frombuffer(data, NUMBERS[kind], size, at).astype(np.float32)
        if not np.isfinite(values).all():
            raise ValueError(f"{path} holds numbers that are not finite in {name}")
        tensors[name] = torch.from_numpy(values.reshape(shape))
        at += size * NUMBERS[kind].itemsize
    return tensors
