"""The whole pipeline on generated motion: npm run test:training. Needs PyTorch, so the module imports it only within
tests.
"""

import hashlib
import io
import json
from dataclasses import replace

import numpy as np
import onnxruntime
import pytest
from rich.console import Console

pytestmark = pytest.mark.training

SEED = 5


@pytest.fixture(scope="module", autouse=True)
def one_thread():
    """Limits torch to one thread, as the pipeline does: on a busy machine several threads take minutes for seconds of
    work.
    """
    import torch

    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    from threepoint_training.training_config import TrainConfig, quick

    base = quick(TrainConfig(mocap=None, folds=("A",), seed=SEED, out=tmp_path_factory.mktemp("models")))
    base = replace(base, cross_validation=tmp_path_factory.mktemp("folds"), fp32_out=tmp_path_factory.mktemp("fp32"))
    return replace(
        base, learned=replace(base.learned, steps=60, batch=256, seed=SEED), paper=replace(base.paper, seed=SEED)
    )


@pytest.fixture(scope="module")
def corpus():
    from threepoint_training.generated_motion import generate_corpus

    return generate_corpus(people=5, clips=3, frames=400, seed=SEED)


@pytest.fixture(scope="module")
def printed():
    """What the run of the module says."""
    return io.StringIO()


@pytest.fixture(scope="module")
def run(config, printed):
    """The pipeline's table, after it wrote its models."""
    from threepoint_training import pipeline

    return pipeline.main(config, Console(file=printed, width=200))


def contract(folder, name):
    return json.loads((folder / f"{name}.json").read_text())


@pytest.mark.parametrize("name", ["paper", "learned"])
def test_the_pipeline_writes_a_model_that_keeps_its_contract(config, run, name):
    stated = contract(config.out, name)
    assert stated["seed"] == SEED
    assert stated["trainedOn"]["people"]
    assert stated["bytes"] == (config.out / stated["file"]).stat().st_size
    assert all(set(errors) >= {"mean", "pelvis"} for errors in stated["errors"].values())
    if name == "learned":
        weights = stated["weights"]
        assert weights["sha256"] == hashlib.sha256((config.out / weights["file"]).read_bytes()).hexdigest()
    session = onnxruntime.InferenceSession(config.out / stated["file"])
    given = np.random.default_rng(1).normal(size=stated["inputs"][0]["shape"]).astype(np.float32)
    (output,) = session.run([stated["outputs"][0]["name"]], {stated["inputs"][0]["name"]: given})
    assert list(output.shape) == stated["outputs"][0]["shape"]
    assert np.isfinite(output).all()


def test_watching_the_network_learn_changes_no_weight(config, corpus):
    from threepoint_training import train_paper

    frames = train_paper.frames_of(corpus, ("002", "003"), SEED)
    chosen = np.arange(len(frames.inputs))

    def weights(watch):
        network = train_paper.train(frames, chosen, config.paper, watch=watch)
        return np.concatenate([value.numpy().ravel() for value in network.state_dict().values()])

    epochs = []
    watched = weights(lambda epoch, network: (epochs.append(epoch), train_paper.predict(network, frames.inputs)))
    np.testing.assert_array_equal(watched, weights(lambda *_: None))
    assert len(epochs) == 4 * config.paper.epochs


@pytest.mark.parametrize("name", ["paper", "learned"])
def test_the_32_bit_network_is_the_same_one_unquantised(config, run, name):
    stated, exact = contract(config.cross_validation, name), contract(config.fp32_out, name)
    assert exact["bytes"] == (config.fp32_out / exact["file"]).stat().st_size > 2 * stated["bytes"]
    given = np.random.default_rng(1).normal(size=stated["inputs"][0]["shape"]).astype(np.float32)
    outputs = [
        onnxruntime.InferenceSession(folder / f"{name}.onnx").run(None, {stated["inputs"][0]["name"]: given})[0]
        for folder in (config.cross_validation, config.fp32_out)
    ]
    assert 0 < np.abs(outputs[0] - outputs[1]).max() < 0.1 * np.abs(outputs[1]).max()


def test_the_table_has_a_row_per_estimator_and_protocol(run):
    held_out = [f"{name}, fold A (005)" for name in ("IK", "paper", "learned")]
    seen = [f"{name}, all subjects, trained on" for name in ("paper", "learned")]
    assert list(run) == held_out + seen
    assert all(0 < values["mean"] < 60 for values in run.values())


@pytest.mark.parametrize("name", ["paper", "learned"])
def test_the_page_s_networks_know_all_subjects_and_carry_the_errors_on_people_held_out(config, run, name):
    held_out, shipped = contract(config.cross_validation, name), contract(config.out, name)
    subjects = set(shipped["trainedOn"]["people"])
    assert set(held_out["trainedOn"]["people"]) < subjects
    assert {"005"} == subjects - set(held_out["trainedOn"]["people"])
    assert held_out["errors"].items() < shipped["errors"].items()
    assert shipped["sha256"] != held_out["sha256"]


def test_the_paper_s_network_is_made_of_the_varied_people_alone_and_says_so(config, run, printed):
    """004, 006 and 007 of the generated people are not among the varied."""
    people = {
        (folder, name): contract(folder, name)["trainedOn"]["people"]
        for folder in (config.out, config.cross_validation)
        for name in ("paper", "learned")
    }
    assert people[config.out, "paper"] == ["002", "003", "005"]
    assert people[config.out, "learned"] == ["002", "003", "004", "005", "006", "007"]
    assert people[config.cross_validation, "paper"] == ["002", "003"]
    assert people[config.cross_validation, "learned"] == ["002", "003", "004", "006", "007"]
    lines = printed.getvalue().splitlines()
    assert "generated motion: 24 clips of 6 people, 4 minutes at 60 Hz" in lines
    assert "paper, fold A: trained on 2 of 6 people: 002, 003" in lines
    assert "paper, all subjects: trained on 3 of 6 people: 002, 003, 005" in lines
    assert "learned, all subjects: trained on all 6 people" in lines


def test_kinematics_are_refitted_on_all_trainable_people(config, tmp_path, monkeypatch):
    from threepoint_training import fitted_kinematics, pipeline, skeleton, solve_ik
    from threepoint_training.generated_motion import generate_corpus

    files = {}
    for module, name in ((skeleton, "PROPORTIONS_FILE"), (solve_ik, "PARAMETERS_FILE")):
        files[name] = tmp_path / name
        files[name].write_bytes(getattr(module, name).read_bytes())
        monkeypatch.setattr(module, name, files[name])
    pipeline.main(replace(config, refit_kinematics=True, networks=()))
    corpus = generate_corpus(people=6, clips=4, frames=600, seed=SEED)
    assert "005" in corpus.people
    fitted = fitted_kinematics.fit(corpus, tuple(corpus.people), config.ik)
    assert json.loads(files["PROPORTIONS_FILE"].read_text()) == fitted.proportions
    assert json.loads(files["PARAMETERS_FILE"].read_text()) == fitted.parameters


def test_errors_from_other_motion_are_refused(config, run, tmp_path):
    from threepoint_training import pipeline
    from threepoint_training.motion_files import MocapError

    with pytest.raises(MocapError, match="other motion"):
        pipeline.main(replace(config, seed=SEED + 1, stages=("all-subjects",), out=tmp_path))


def test_the_loss_of_both_networks_falls(config, corpus):
    from threepoint_training import train_learned, train_paper

    people = tuple(corpus.people)
    losses = []
    train_learned.train(corpus, people, config.learned, lambda step, loss: losses.append(loss))
    assert np.mean(losses[-10:]) < 0.9 * np.mean(losses[:5])
    losses.clear()
    frames = train_paper.frames_of(corpus, people, SEED)
    paper = replace(config.paper, epochs=3, batch=128)
    train_paper.train(frames, np.arange(len(frames.inputs)), paper, lambda epoch, iteration, loss: losses.append(loss))
    assert losses[-1] < 0.5 * losses[0]


def test_eight_bits_agree_with_thirty_two(config, corpus):
    """In error and in jerk: weights of 8 bits must not make the joints tremble."""
    from threepoint_training import train_learned
    from threepoint_training.export import to_onnx
    from threepoint_training.quantise import quantise_weights, run

    people = tuple(corpus.people)
    network = train_learned.train(corpus, people, config.learned)
    inputs = train_learned.held_out(corpus, people[:1], config.learned.window_seconds).inputs[:300]
    exact = to_onnx(network, inputs[:1], "features", "joints")
    fp32, int8 = run(exact, inputs), run(quantise_weights(exact), inputs)
    assert 0 < np.abs(fp32 - int8).max() < 0.01
    jerk = [np.abs(np.diff(output, 3, axis=0)).mean() for output in (fp32, int8)]
    assert jerk[1] < 1.05 * jerk[0]


def test_onnx_says_what_the_network_says(config, corpus):
    import torch
    from threepoint_training import train_learned
    from threepoint_training.export import to_onnx
    from threepoint_training.model import PaperNetwork
    from threepoint_training.quantise import run

    learned = train_learned.train(corpus, tuple(corpus.people), replace(config.learned, steps=3))
    inputs = train_learned.held_out(corpus, ("002",), config.learned.window_seconds).inputs[:20]
    paper = PaperNetwork().eval()
    paper_inputs = np.random.default_rng(2).normal(size=(20, 2, 3, 3)).astype(np.float32)
    for network, given in ((learned, inputs), (paper, paper_inputs)):
        with torch.no_grad():
            expected = network(torch.from_numpy(given)).numpy()
        np.testing.assert_allclose(run(to_onnx(network, given[:1], "in", "out"), given), expected, atol=1e-5)


def test_the_paper_s_network_has_the_paper_s_size():
    from threepoint_training.model import PaperNetwork

    network = PaperNetwork()
    assert sum(p.numel() for p in network.parameters()) == pytest.approx(1.58e6, rel=0.005)
    assert [c.out_channels for c in network.convolutions] == [32, 64, 128, 256]


def test_the_same_seed_makes_the_same_weights_and_another_seed_others(config, corpus):
    from threepoint_training import train_learned

    def weights(seed):
        network = train_learned.train(corpus, tuple(corpus.people), replace(config.learned, steps=12, seed=seed))
        return np.concatenate([value.numpy().ravel() for value in network.state_dict().values()])

    first = weights(1)
    np.testing.assert_array_equal(first, weights(1))
    assert np.abs(first - weights(2)).max() > 1e-3


def test_the_whole_run_is_repeatable_to_the_byte(config, run, tmp_path):
    from threepoint_training import pipeline

    pipeline.main(replace(config, out=tmp_path / "models", cross_validation=tmp_path / "folds"))
    for name in ("paper", "learned"):
        assert contract(tmp_path / "models", name)["sha256"] == contract(config.out, name)["sha256"]
