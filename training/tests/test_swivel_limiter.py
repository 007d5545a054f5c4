"""Facts about elbows that are kept out of the trunk."""

import pytest
import torch
from threepoint_training.shared_constants import TRUNK_CAPSULE
from threepoint_training.swivel_limiter import ElbowCircles, Trunk, limit_swivel

pytestmark = pytest.mark.training

COUNT = 400
# An upright trunk [m], hips at the origin.
TRUNK = Trunk(
    hips=torch.zeros(COUNT, 3, dtype=torch.float64),
    chest=torch.tensor([0.0, 0.25, 0.0], dtype=torch.float64).expand(COUNT, 3),
    neck=torch.tensor([0.0, 0.45, 0.0], dtype=torch.float64).expand(COUNT, 3),
    upper_chest=torch.eye(3, dtype=torch.float64).expand(COUNT, 3, 3),
)


def unit(vectors):
    return vectors / vectors.norm(dim=-1, keepdim=True)


@pytest.fixture(scope="module")
def arms():
    """Elbows on circles beside and before the trunk, about lines in any direction, and where each is."""
    random = torch.Generator().manual_seed(1)
    outward, up, back = torch.rand((3, COUNT, 2), generator=random, dtype=torch.float64)
    side = torch.tensor([-1.0, 1.0], dtype=torch.float64)
    centre = torch.stack([side * (0.2 + 0.15 * outward), 0.4 * up, 0.1 - 0.35 * back], dim=-1)
    axis = unit(torch.randn((COUNT, 2, 3), generator=random, dtype=torch.float64))
    pole = torch.randn((COUNT, 2, 3), generator=random, dtype=torch.float64)
    pole = unit(pole - (pole * axis).sum(-1, keepdim=True) * axis)
    return ElbowCircles(centre, axis, torch.full((COUNT, 2, 1), 0.22, dtype=torch.float64)), pole


def distance_in_capsule(circles, pole):
    """From the capsule's axis; below 1: in the trunk."""
    thorax = 0.2
    x, y, z = (circles.centre + circles.radius * pole).unbind(-1)
    beyond = y - y.clamp(0, 0.45)
    scaled = [x / TRUNK_CAPSULE["halfWidth"], beyond / TRUNK_CAPSULE["cap"], z / TRUNK_CAPSULE["halfDepth"]]
    return torch.stack(scaled).norm(dim=0) / thorax


def test_an_elbow_in_the_trunk_comes_to_lie_on_its_surface(arms):
    circles, pole = arms
    inside = distance_in_capsule(circles, pole) < 1
    limited_pole, limited = limit_swivel(circles, pole, TRUNK)
    assert 30 < inside.sum() < COUNT
    # The border is looked for in steps of 10°: a circle that touches the trunk between two of them is let be.
    assert limited[inside].float().mean() > 0.95
    after = distance_in_capsule(circles, limited_pole)[limited]
    # A circle that lies in the trunk altogether has no place outside it.
    free = after > 0.99
    assert free.float().mean() > 0.8
    assert after[free].median() < 1.01


def test_an_elbow_that_may_stay_does_not_move_and_one_that_was_moved_stays(arms):
    circles, pole = arms
    once, limited = limit_swivel(circles, pole, TRUNK)
    torch.testing.assert_close(once[~limited], pole[~limited], rtol=0, atol=0)
    twice, _ = limit_swivel(circles, once, TRUNK)
    torch.testing.assert_close(twice, once, rtol=0, atol=1e-9)
    torch.testing.assert_close(once.norm(dim=-1), torch.ones(COUNT, 2, dtype=torch.float64))
    torch.testing.assert_close((once * circles.axis).sum(-1), torch.zeros(COUNT, 2, dtype=torch.float64))


def test_arms_and_their_mirror_images_are_limited_alike(arms):
    circles, pole = arms
    flip = torch.tensor([-1.0, 1.0, 1.0], dtype=torch.float64)
    image = ElbowCircles(circles.centre.flip(1) * flip, circles.axis.flip(1) * flip, circles.radius)
    mirrored, _ = limit_swivel(image, pole.flip(1) * flip, TRUNK)
    once, _ = limit_swivel(circles, pole, TRUNK)
    torch.testing.assert_close(mirrored.flip(1) * flip, once, rtol=0, atol=1e-9)
