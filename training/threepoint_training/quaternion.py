"""Quaternions as arrays [..., 4] in the order x, y, z, w; every function is vectorised over the leading axes."""

import numpy as np

from .arrays import Array


def multiply(a: Array, b: Array) -> Array:
    """The rotation b followed by a."""
    ax, ay, az, aw = np.moveaxis(a, -1, 0)
    bx, by, bz, bw = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        axis=-1,
    )


def conjugate(q: Array) -> Array:
    """The inverse of a unit quaternion."""
    return q * np.array([-1.0, -1.0, -1.0, 1.0])


def rotate(q: Array, v: Array) -> Array:
    """The vectors v [..., 3] rotated by q."""
    x, y, z, w = (q[..., part] for part in range(4))
    vx, vy, vz = (v[..., part] for part in range(3))
    # By components: np.cross takes three times as long.
    tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return np.stack(
        [vx + w * tx + (y * tz - z * ty), vy + w * ty + (z * tx - x * tz), vz + w * tz + (x * ty - y * tx)], axis=-1
    )


def from_axis_angle(axis: Array, angle: Array) -> Array:
    """The rotation by angle [rad] about the unit vector axis."""
    half = np.asarray(angle)[..., None] / 2.0
    return np.concatenate([np.sin(half) * axis, np.cos(half) * np.ones_like(axis[..., :1])], axis=-1)


def from_rotation_vector(v: Array) -> Array:
    """The rotation by |v| [rad] about v; the identity for zero."""
    angle = np.linalg.norm(v, axis=-1)
    axis = v / np.maximum(angle, 1e-12)[..., None]
    return from_axis_angle(axis, angle)


def from_matrix(m: Array) -> Array:
    """The unit quaternion of rotation matrices [..., 3, 3], w ≥ 0."""
    # 4·q·qᵀ: each row is the quaternion times one of its components. The largest component is the best conditioned.
    products = np.empty((*m.shape[:-2], 4, 4))
    products[..., :3, :3] = m + np.swapaxes(m, -1, -2)
    trace = np.trace(m, axis1=-2, axis2=-1)
    for axis in range(3):
        after, before = (axis + 1) % 3, (axis + 2) % 3
        products[..., axis, axis] += 1 - trace
        products[..., axis, 3] = products[..., 3, axis] = m[..., before, after] - m[..., after, before]
    products[..., 3, 3] = 1 + trace
    best = np.argmax(np.diagonal(products, axis1=-2, axis2=-1), axis=-1)
    q = np.take_along_axis(products, best[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(q[..., 3:] < 0, -q, q)


def to_matrix(q: Array) -> Array:
    """Rotation matrices [..., 3, 3]."""
    x, y, z, w = np.moveaxis(q, -1, 0)
    return np.stack(
        [
            np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], -1),
            np.stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], -1),
            np.stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], -1),
        ],
        axis=-2,
    )


def rotation_between(a: Array, b: Array) -> Array:
    """The smallest rotation that takes the direction of a to that of b; half a turn about any normal when they oppose.
    """
    a = a / np.linalg.norm(a, axis=-1, keepdims=True)
    b = b / np.linalg.norm(b, axis=-1, keepdims=True)
    w = 1.0 + np.sum(a * b, axis=-1, keepdims=True)
    fallback = np.cross(a, np.where(np.abs(a[..., :1]) < 0.9, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])))
    q = np.where(w < 1e-9, np.concatenate([fallback, np.zeros_like(w)], -1), np.concatenate([np.cross(a, b), w], -1))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def continuous(q: Array) -> Array:
    """Flips signs so that neighbours along the first axis lie in the same hemisphere."""
    flips = np.sign(np.sum(q[1:] * q[:-1], axis=-1))
    flips = np.where(flips == 0, 1.0, flips)
    return q * np.concatenate([np.ones_like(flips[:1]), np.cumprod(flips, axis=0)])[..., None]


def slerp(a: Array, b: Array, t: Array) -> Array:
    """Interpolation along the shorter arc; t in [0, 1] broadcasts over the leading axes."""
    t = np.asarray(t)[..., None]
    cosine = np.sum(a * b, axis=-1, keepdims=True)
    b = np.where(cosine < 0, -b, b)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    small = angle < 1e-4
    sine = np.where(small, 1.0, np.sin(angle))
    q = np.where(small, (1 - t) * a + t * b, np.sin((1 - t) * angle) / sine * a + np.sin(t * angle) / sine * b)
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def heading(q: Array) -> Array:
    """The rotation about +Y [..., 4] of a head with orientation q, from its right axis (docs/estimation.md)."""
    right = rotate(q, np.broadcast_to([1.0, 0.0, 0.0], (*q.shape[:-1], 3)))
    gaze = rotate(q, np.broadcast_to([0.0, 0.0, -1.0], (*q.shape[:-1], 3)))
    forward = np.stack([right[..., 2], -right[..., 0]], -1)
    for substitute in (gaze[..., [0, 2]], np.broadcast_to([0.0, -1.0], forward.shape)):
        degenerate = np.linalg.norm(forward, axis=-1, keepdims=True) < 1e-3
        forward = np.where(degenerate, substitute, forward)
    yaw = np.arctan2(-forward[..., 0], -forward[..., 1])
    return from_axis_angle(np.broadcast_to([0.0, 1.0, 0.0], (*yaw.shape, 3)), yaw)
