"""Facts about what a command line of `npm run tool -- train` asks for."""

import pytest
from threepoint_training.__main__ import config_of
from threepoint_training.training_config import TrainConfig

pytestmark = pytest.mark.training


def test_without_options_the_recipe_is_trained():
    config = config_of(["--generated"])
    assert (config.task, config.learned.steps) == ("train", TrainConfig.learned.steps)


def test_a_quick_run_takes_the_steps_that_it_is_given():
    assert config_of(["--generated", "--quick", "--steps", "7"]).learned.steps == 7
    assert config_of(["--generated", "--quick"]).learned.steps < TrainConfig.learned.steps
    assert config_of(["--generated", "--steps", "7"]).learned.steps == 7


def test_a_run_has_one_seed_for_both_networks():
    for arguments in (["--quick"], []):
        config = config_of(["--generated", "--seed", "3", *arguments])
        assert (config.paper.seed, config.learned.seed) == (3, 3)


def test_a_board_has_one_seed_for_all_networks_and_bounds_those_of_the_field():
    config = config_of(["--generated", "--board", "--seed", "3", "--steps", "7"])
    assert (config.paper.seed, config.learned.seed, config.board.seed) == (3, 3, 3)
    assert (config.board.steps, config.learned.steps) == (7, TrainConfig.learned.steps)


@pytest.mark.parametrize(
    ("option", "task"), [("--select", "selection"), ("--online-calibration", "online calibration"), ("--lockbox", "lockbox")]
)
def test_a_study_is_done_instead_of_the_training(option, task):
    assert config_of(["--generated", option]).task == task


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--groups", "4"], "--groups 4 is of --select: give that too"),
        (["--select", "--groups", "1"], "--groups 1: two groups at least"),
        (["--lockbox", "--steps", "7"], "--lockbox trains nothing: it takes neither --steps nor --quick"),
        (["--lockbox", "--quick"], "--lockbox trains nothing: it takes neither --steps nor --quick"),
    ],
)
def test_options_that_would_be_ignored_are_refused_in_a_sentence(options, sentence, capsys):
    with pytest.raises(SystemExit):
        config_of(["--generated", *options])
    assert sentence in " ".join(capsys.readouterr().err.split())


def test_two_studies_at_once_are_refused_in_a_sentence(capsys):
    with pytest.raises(SystemExit):
        config_of(["--generated", "--online-calibration", "--select"])
    assert "--online-calibration and --select are runs of their own: give one of them" in capsys.readouterr().err
