"""Facts about recombined bodies."""

from dataclasses import replace

import numpy as np
import pytest
from threepoint_training import hand_tilt, mirror, quaternion
from threepoint_training.augment import AugmentConfig, draw_batch
from threepoint_training.body_parts import BalanceConfig, BodyParts
from threepoint_training.chest_features import CHEST_FEATURES, chest_axes
from threepoint_training.features import ARM_LENGTH, FEATURES, HANDS, HEADSET_HEIGHT, IK_JOINTS, SEEN, frame_features
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.prepare import EYES_FROM_HEAD_JOINT
from threepoint_training.residual import network_input, residual
from threepoint_training.simulate_trackers import TrackerConfig, Wearer, simulate
from threepoint_training.skeleton import body_from_calibration

CORPUS = generate_corpus(people=3, clips=2, frames=80, seed=6)
PARTS = BodyParts(CORPUS, tuple(CORPUS.people))
EXACT = TrackerConfig(*[0.0] * 4, (0.0,) * 3, (0.0,) * 3, 0.0)
PLAIN = AugmentConfig(
    recombined=0,
    lost_hand=0,
    returned=0,
    late=0,
    seated=0,
    arm_scale=0,
    eye_height_error=0,
    arm_span_error=0,
    typed_forearms=0,
    trackers=EXACT,
)
STILL = np.array([0.0, 0.0, 0.0, 1.0])


def corpus_rows(corpus=CORPUS, tilts_of=None):
    """Inputs and targets of every frame of the corpus with exact trackers, as it is and mirrored; hands turned by these
    tilts, else the own.
    """
    tilts_of = tilts_of or hand_tilt.ForearmMeans(corpus, tuple(corpus.people)).of
    wearer = Wearer(EYES_FROM_HEAD_JOINT, STILL, np.zeros((2, 3)), np.stack([STILL, STILL]))
    rows = []
    for clip, person in enumerate(corpus.clip_people):
        frames = corpus.clip_slice(clip)
        tracked = simulate(corpus.positions[frames], corpus.rotations[frames], wearer, EXACT, np.random.default_rng(0))
        body = body_from_calibration(
            np.array(corpus.people[person].eye_height), np.array(corpus.people[person].arm_span)
        )
        truth, tilts = corpus.truth(frames).astype(np.float64), tilts_of(person)
        as_it_is, image = (
            (*tracked, truth, tilts),
            (*mirror.trackers(*tracked), mirror.joints(truth), mirror.tilts(tilts)),
        )
        for positions, rotations, joints, hands in (as_it_is, image):
            turned = body.with_hands(hands)
            vector, _ = frame_features(positions, rotations, turned)
            given = network_input(vector, np.arange(len(vector)) / 60, (0, 0.1, 0.25))
            rows.append((given, residual(joints, positions, rotations, turned, vector)))
    return tuple(np.concatenate(column) for column in zip(*rows, strict=True))


def joints_of(batch):
    """The true joints [N, 6, 3] from the headset, heading frame, eye heights."""
    newest = batch.inputs[:, :FEATURES].astype(np.float64)
    return newest[:, IK_JOINTS].reshape(-1, 6, 3) + batch.targets.reshape(-1, 6, 3) @ chest_axes(newest)


def hand_positions(inputs):
    """Left and right wrist [..., 2, 3] of inputs [..., ≥ 46]: from the headset, heading frame, in arm lengths."""
    return np.stack([inputs[..., hand.start : hand.start + 3] for hand in HANDS], axis=-2)


def assert_rows_of(batch, rows):
    """Every window of the batch is one of these, about half of them mirrored."""
    inputs, targets = rows
    nearest = [int(np.argmin(np.abs(inputs - given).max(axis=1))) for given in batch.inputs]
    np.testing.assert_allclose(batch.inputs, inputs[nearest], atol=1e-4)
    np.testing.assert_allclose(batch.targets, targets[nearest], atol=1e-5)
    mirrored = np.array(nearest) // 80 % 2
    assert 0.25 < mirrored.mean() < 0.75


def test_without_any_variation_a_window_is_the_corpus_s_own_or_its_mirror_image():
    assert_rows_of(draw_batch(PARTS, 60, PLAIN, np.random.default_rng(1)), corpus_rows())


def test_hands_of_tilts_that_no_hand_has_are_turned_by_the_usual_one():
    turned = hand_turned_corpus(1.3)
    parts = BodyParts(turned, tuple(turned.people))
    assert not hand_tilt.plausible(parts.tilts).any()
    assert_rows_of(
        draw_batch(parts, 60, PLAIN, np.random.default_rng(1)), corpus_rows(turned, lambda _: hand_tilt.usual())
    )


def test_people_count_alike_at_an_exponent_of_one_however_much_there_is_of_them():
    people = ("002", "003")
    # The first person has half of the second's frames.
    shorter = replace(
        CORPUS, clip_people=("010", *CORPUS.clip_people[1:]), people=CORPUS.people | {"010": CORPUS.people["002"]}
    )
    parts = BodyParts(shorter, people, BalanceConfig(people=1.0))
    assert np.bincount(parts.person).tolist() == [80, 160]
    drawn = (parts.draw_trunks(np.random.default_rng(3), 6000), parts.draw_arms(np.random.default_rng(4), 6000)[0])
    for frames in drawn:
        np.testing.assert_allclose(np.bincount(parts.person[frames]) / 6000, [0.5, 0.5], atol=0.03)


def test_arms_of_others_move_the_hands_but_not_the_torso():
    plain = draw_batch(PARTS, 200, PLAIN, np.random.default_rng(2))
    mixed = draw_batch(PARTS, 200, replace(PLAIN, recombined=1.0), np.random.default_rng(2))
    # Both draws select the same frames but mirror differently: compare the height of the hips, which mirroring keeps.
    np.testing.assert_allclose(joints_of(mixed)[:, 5, 1], joints_of(plain)[:, 5, 1], atol=1e-5)
    assert np.abs(hand_positions(mixed.inputs) - hand_positions(plain.inputs)).max() > 0.3


@pytest.mark.parametrize("recombined", [0.0, 1.0])
def test_arms_have_the_length_that_the_calibration_knows(recombined):
    """Upper arm and forearm as ratios of each other are a person's; their sum is the body's it was put on."""
    config = replace(PLAIN, recombined=recombined, arm_scale=0.05)
    batch = draw_batch(PARTS, 300, config, np.random.default_rng(3))
    joints = joints_of(batch)
    span_ratio = batch.inputs[:, ARM_LENGTH]
    for elbow, shoulder, hand in ((0, 2, slice(7, 10)), (1, 3, slice(16, 19))):
        wrist = batch.inputs[:, hand] * span_ratio[:, None]
        length = np.linalg.norm(joints[:, elbow] - joints[:, shoulder], axis=1) + np.linalg.norm(
            wrist - joints[:, elbow], axis=1
        )
        # Generated people are 0.24 of the eye height between the shoulders, the calibrated skeleton a little less.
        assert np.abs(length / span_ratio - 1).max() < 0.06


def test_typed_forearms_are_those_of_the_arms_that_were_drawn():
    """On either side, in a mirror or not: IK's arms have more of the drawn ones' own bones."""
    without, typed = (
        draw_batch(
            PARTS,
            300,
            replace(PLAIN, recombined=1.0, typed_forearms=part, forearm_error=0.0),
            np.random.default_rng(10),
        )
        for part in (0, 1)
    )

    def upper_arms(joints):
        return np.linalg.norm(joints[:, :2] - joints[:, 2:4], axis=-1)

    # The frames drawn are the same ones, and so is the truth.
    own = upper_arms(joints_of(typed))
    np.testing.assert_allclose(own, upper_arms(joints_of(without)), atol=1e-4)
    average, with_typed = (upper_arms(batch.inputs[:, IK_JOINTS].reshape(-1, 6, 3)) for batch in (without, typed))
    assert np.corrcoef((own - average).ravel(), (with_typed - average).ravel())[0, 1] > 0.99


def test_a_lost_hand_says_so_and_comes_to_rest_beside_the_hips_in_time():
    def resting(lost_frames, hand, sign):
        batch = draw_batch(PARTS, 400, replace(PLAIN, lost_hand=1.0, lost_frames=lost_frames), np.random.default_rng(4))
        assert (batch.inputs[:, SEEN] == 0).all()
        wrist = batch.inputs[:, hand]
        return ((wrist[:, 1] < -0.9) & (sign * wrist[:, 0] > 0.1)).mean()

    for hand, sign in ((slice(7, 10), -1), (slice(16, 19), 1)):
        shares = [resting(frames, hand, sign) for frames in (6, 120, 1200)]
        assert shares[0] < shares[1] < shares[2]
        assert shares[2] > 0.85


def test_a_hand_lost_for_a_moment_is_where_it_was_while_the_arm_moves_on():
    held = replace(PLAIN, lost_hand=1.0, lost_frames=6)
    seen, frozen = (draw_batch(PARTS, 300, config, np.random.default_rng(7)) for config in (PLAIN, held))
    moved = np.linalg.norm((hand_positions(frozen.inputs) - hand_positions(seen.inputs))[:, 0], axis=1)
    # Six frames of generated motion: some hands moved by centimetres, none to the hips.
    assert 0.002 < np.median(moved) < 0.2


def lost_for_frames(window, frames):
    """Every hand lost for one to `frames` frames, and the same windows with every hand seen."""
    plain = replace(PLAIN, window_frames=window, lost_frames=frames)
    return (draw_batch(PARTS, 300, replace(plain, lost_hand=part), np.random.default_rng(7)) for part in (1.0, 0.0))


def frame_of(batch, place):
    """Features [N, 46] of this frame of the window."""
    return batch.inputs[:, place * FEATURES : (place + 1) * FEATURES]


def test_a_hand_that_has_just_been_lost_is_seen_in_the_earlier_frames_of_the_window():
    lost, seen = lost_for_frames((0, 6, 15), 1)
    assert (frame_of(lost, 0)[:, SEEN] == 0).all()
    assert np.abs(hand_positions(frame_of(lost, 0)) - hand_positions(frame_of(seen, 0))).max() > 0.01
    np.testing.assert_array_equal(lost.inputs[:, FEATURES : 3 * FEATURES], seen.inputs[:, FEATURES : 3 * FEATURES])


def test_a_hand_lost_for_the_whole_window_is_held_at_one_place_beside_the_headset():
    """Six frames are as long as a hand is held."""
    lost, _ = lost_for_frames((0, 4), 6)
    newest, before = frame_of(lost, 0), frame_of(lost, 1)
    held = before[:, SEEN] == 0
    # A third of the hands: those lost for five or six frames.
    assert held.mean() == pytest.approx(1 / 3, abs=0.06)
    np.testing.assert_allclose(hand_positions(newest)[held], hand_positions(before)[held], atol=1e-6)


def test_a_hand_that_has_been_seen_again_was_lost_in_earlier_frames_of_the_window():
    """It is back for one to sixteen frames of a window of fifteen: the last of them were before the loss was over."""
    plain = replace(PLAIN, window_frames=(0, 6, 15), lost_frames=60, returned=1.0)
    back, seen = (
        draw_batch(PARTS, 2000, replace(plain, lost_hand=part), np.random.default_rng(7)) for part in (1.0, 0.0)
    )
    np.testing.assert_array_equal(frame_of(back, 0), frame_of(seen, 0))
    lost = [frame_of(back, place)[:, SEEN] == 0 for place in (1, 2)]
    # Back for at most six of the sixteen, or for fifteen, and not lost so shortly that it was seen before that.
    assert lost[0].mean() == pytest.approx(6 / 16, abs=0.05)
    assert lost[1].mean() == pytest.approx(15 / 16, abs=0.12)
    moved = hand_positions(frame_of(back, 2))[lost[1]] - hand_positions(frame_of(seen, 2))[lost[1]]
    assert np.median(np.linalg.norm(moved, axis=1)) > 0.02


def test_trackers_jitter_in_position_and_rotation_at_every_frame_of_the_window_anew():
    still = replace(PLAIN, window_frames=(0, 6))
    jittery = replace(still, trackers=replace(EXACT, position_noise=(1e-3,) * 3, rotation_noise=(1e-2,) * 3))
    exact, noisy = (draw_batch(PARTS, 2000, config, np.random.default_rng(12)) for config in (still, jittery))
    moved = [frame_of(noisy, place) - frame_of(exact, place) for place in (0, 1)]
    for frame in moved:
        # In eye heights; generated people's are 1.4 to 1.8 m.
        assert 0.5e-3 < frame[:, HEADSET_HEIGHT].std() < 0.75e-3
        # An axis is moved by the rotations about the two others, and by those of the head that the heading frame
        # follows.
        assert np.linalg.norm(frame[:, HANDS[0]][:, 3:6], axis=1).mean() == pytest.approx(
            1e-2 * np.sqrt(2 / 3), rel=0.25
        )
    assert abs(np.corrcoef(*(frame[:, HEADSET_HEIGHT] for frame in moved))[0, 1]) < 0.1


def test_late_trackers_tell_of_the_frame_before():
    on_time, late = (draw_batch(PARTS, 300, replace(PLAIN, late=part), np.random.default_rng(8)) for part in (0.0, 1.0))
    # The newest of a late window is the same person one frame earlier: nearly the same, not the same.
    difference = np.abs(on_time.inputs[:, : SEEN.start] - late.inputs[:, : SEEN.start]).max(axis=1)
    assert 1e-4 < np.median(difference) < 0.2


def test_seated_people_are_lower_and_shaped_the_same():
    standing, seated = (
        draw_batch(PARTS, 200, replace(PLAIN, seated=part), np.random.default_rng(9)) for part in (0.0, 1.0)
    )
    drop = standing.inputs[:, 0] - seated.inputs[:, 0]
    assert (drop > 0.19).all()
    assert (drop < 0.36).all()
    np.testing.assert_allclose(joints_of(seated), joints_of(standing), atol=1e-5)


def test_hands_continue_their_forearms_on_average():
    """The hand's −Z lies along the forearm, except for the bend of the wrist, for every person, side and mirror image.
    """

    def bends(corpus):
        batch = draw_batch(
            BodyParts(corpus, tuple(corpus.people)), 400, replace(PLAIN, recombined=1.0), np.random.default_rng(6)
        )
        hands = hand_positions(batch.inputs) * batch.inputs[:, ARM_LENGTH, None, None]
        forearms = hands - joints_of(batch)[:, :2]
        forearms /= np.linalg.norm(forearms, axis=-1, keepdims=True)
        axes = np.stack([batch.inputs[:, hand][:, 3:].reshape(-1, 2, 3) for hand in HANDS], axis=1)
        along = -np.cross(axes[:, :, 0], axes[:, :, 1])
        return np.degrees(np.arccos(np.clip(np.sum(along * forearms, axis=-1), -1, 1)))

    # Wrists of generated people wave by some 20°, however they are worn.
    as_they_are, worn_off = bends(CORPUS), bends(hand_turned_corpus(0.5))
    assert 10 < np.median(as_they_are) < 25
    np.testing.assert_allclose(worn_off, as_they_are, atol=0.1)


def hand_turned_corpus(angle):
    """The corpus with hands that are so far off their forearms [rad], each side another way."""
    turns = quaternion.from_rotation_vector(np.array([[0.0, 0.0, 0.0], [angle, 0.0, 0.0], [0.0, angle, 0.0]]))
    return replace(CORPUS, rotations=quaternion.multiply(CORPUS.rotations.astype(np.float64), turns).astype(np.float32))


def test_a_batch_is_finite_and_repeatable():
    config = AugmentConfig()
    first, second = (draw_batch(PARTS, 128, config, np.random.default_rng(5)) for _ in range(2))
    assert first.inputs.shape == (128, FEATURES * len(config.window_frames) + CHEST_FEATURES)
    assert np.isfinite(first.inputs).all()
    np.testing.assert_array_equal(first.inputs, second.inputs)
    np.testing.assert_array_equal(first.targets, second.targets)
    assert np.abs(first.targets).mean() < 0.15


def test_arms_of_a_recombined_body_are_those_of_two_people():
    """Each person's upper arms have a share of the arm that identifies the person."""
    parts = BodyParts(CORPUS, tuple(CORPUS.people))
    own = np.array([0.3, 0.5, 0.7])
    for arm in parts.arms:
        arm[:, 1] = arm[:, 0] + own[parts.person, None] * (arm[:, 2] - arm[:, 0])

    def people_of_arms(recombined):
        batch = draw_batch(parts, 400, replace(PLAIN, recombined=recombined), np.random.default_rng(6))
        joints = joints_of(batch)
        upper_arm = np.linalg.norm(joints[:, [0, 1]] - joints[:, [2, 3]], axis=-1)
        hands = hand_positions(batch.inputs) * batch.inputs[:, ARM_LENGTH, None, None]
        forearm = np.linalg.norm(hands - joints[:, [0, 1]], axis=-1)
        difference = np.abs((upper_arm / (upper_arm + forearm))[..., None] - own)
        assert difference.min(axis=-1).max() < 1e-4
        return difference.argmin(axis=-1)

    alone, mixed = people_of_arms(0.0), people_of_arms(1.0)
    assert (alone[:, 0] == alone[:, 1]).all()
    # Two of three people drawn independently differ in two thirds of all bodies.
    assert 0.5 < (mixed[:, 0] != mixed[:, 1]).mean() < 0.8
    assert set(mixed.flat) == {0, 1, 2}
