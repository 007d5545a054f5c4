"""The recipes that were compared to choose how the learned network is trained, as differences from one another."""

from dataclasses import dataclass, replace
from typing import Any, Literal

from . import splits
from .augment import BalanceConfig
from .train_learned import TrainLearnedConfig

# Which of the trainable people train: those who were asked for many things, all but those added last, or all.
People = Literal["varied", "first", "all"]


@dataclass(frozen=True)
class Recipe:
    """A way to train the learned network."""

    learned: TrainLearnedConfig
    people: People = "first"

    def trained_on(self, subjects: tuple[str, ...]) -> tuple[str, ...]:
        """The people that this recipe trains on, of the trainable `subjects`."""
        chosen = {
            "varied": set(splits.VARIED),
            "first": set(subjects) - set(splits.ADDED),
            "all": set(subjects),
        }[self.people]
        return tuple(person for person in splits.trainable(subjects) if person in chosen)

    def learned_with(self, **changes: Any) -> "Recipe":
        """The recipe with these fields of its training configuration changed."""
        return replace(self, learned=replace(self.learned, **changes))

    def drawn_with(self, **changes: Any) -> "Recipe":
        """The recipe with these fields of its augmentation changed."""
        return self.learned_with(augment=replace(self.learned.augment, **changes))

    def of(self, people: People) -> "Recipe":
        """The recipe trained on other people."""
        return replace(self, people=people)


# Every recipe is compared after so many steps, unless its name says otherwise.
STEPS = 1000
_RARE = BalanceConfig(people=0.25, varied=1.0, postures=0.7)
_SHIPPED = Recipe(TrainLearnedConfig(steps=STEPS))
_OLD = _SHIPPED.learned_with(elbow_share=1 / 3, shrinkage=0.75, regret_weight=0.0)
_RARE_FRAMES = _OLD.drawn_with(balance=_RARE)
_BASE = _RARE_FRAMES.drawn_with(recorded_hands=True)


def _of_all(name: str, recipe: Recipe) -> dict[str, Recipe]:
    return {f"{name}, {people}": recipe.of(people) for people in ("varied", "first", "all")}


RECIPES: dict[str, Recipe] = {
    **_of_all("shipped", _SHIPPED),
    **_of_all("old", _OLD),
    **_of_all("rare", _RARE_FRAMES),
    **_of_all("recorded hands", _OLD.drawn_with(recorded_hands=True)),
    **_of_all("base", _BASE),
    "base, first, no random effects": _BASE.learned_with(effects_learning_rate=0.0),
    "base, first, regret": _BASE.learned_with(regret_weight=2.0),
    "base, first, elbows 2/3": _BASE.learned_with(elbow_share=2 / 3),
    "base, first, width 96": _BASE.learned_with(width=96),
    "base, first, width 384": _BASE.learned_with(width=384),
    "base, first, no mistaken hands": _BASE.drawn_with(mistaken_hands=0.0),
    "base, first, 3000 steps": _BASE.learned_with(steps=3000),
    "shipped, first, 3000 steps": _SHIPPED.learned_with(steps=3000),
    "base, all, 3000 steps": _BASE.learned_with(steps=3000).of("all"),
    "base, varied, 3000 steps": _BASE.learned_with(steps=3000).of("varied"),
}
