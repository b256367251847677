"""Counts the scores of the angle experiments again, from the answers alone, and compares them with a report.

    boresight-experiments doa --trials 210 --answers answers.jsonl --json > report.json
    python3 research/experiments/recount.py answers.jsonl report.json

The answers are lines of JSON: a head, then an object a trial with the truth and what was answered. The script shares
nothing with the Rust code that wrote the report, and needs the standard library only. It ends with 1 where a number
differs by more than 1e-9 (relative, where it is above 1).

The rules, in degrees:

- aoa: a prediction within 0.5 of any target is right, any other is false, and a target with a right prediction is
  found. The threshold is on the odds of the confidence in dB where a prediction has one, else on its power in dB, in
  steps of 0.25 dB over 70 dB from 35 or 10 dB down; a prediction counts where its level is above the threshold, and at
  the lowest one in any case. Strictly, predictions in falling order of level each take the nearest target within 0.5
  that is still free.
- doa: success is every angle within 1 of its target, both in ascending order; a trial without as many angles as targets
  is a failure. Errors are rounded to 1e-9 before, so that 1 is 1, though the angle was in radians.
"""

import json
import math
import sys
from collections import defaultdict

TOLERANCE = 1e-9
HIT_DEG = 0.5
STEPS_PER_DB, STEPS = 4, 280
SUCCESS_DEG, CLOSE_DEG, LARGEST_DEG = 1.0, 4.0, 10


class Comparison:
    """What was compared, and what differed."""

    def __init__(self):
        self.count, self.wrong = 0, []

    def check(self, what, counted, reported):
        self.count += 1
        if counted is None or reported is None:
            same = counted is None and reported is None
        else:
            same = abs(counted - reported) <= TOLERANCE * max(1.0, abs(reported))
        if not same:
            self.wrong.append(f"{what}: counted {counted}, reported {reported}")


def level_db(prediction):
    """What the threshold of a prediction is on."""
    if len(prediction) < 3:
        return -math.inf if prediction[1] is None else prediction[1]
    confidence = prediction[2]
    if confidence in (0, 1):
        return math.inf if confidence else -math.inf
    return 10 * math.log10(confidence / (1 - confidence))


class Tally:
    """Predictions of one method in one condition, by the first threshold from above at which they count."""

    def __init__(self):
        self.targets = 0
        self.top_db = 10.0
        self.right, self.wrong, self.found, self.matched = ([0] * STEPS for _ in range(4))
        self.angle, self.power = [0.0] * STEPS, [0.0] * STEPS

    def step(self, level):
        if level == -math.inf:
            return STEPS - 1
        if level == math.inf:
            return 0
        return min(max(math.floor((self.top_db - level) * STEPS_PER_DB), 0), STEPS - 1)

    def add(self, truth, predictions):
        if predictions and len(predictions[0]) > 2:
            self.top_db = 35.0
        self.targets += len(truth)
        levels = [level_db(prediction) for prediction in predictions]
        finders = [[] for _ in truth]
        free = set(range(len(truth)))
        for at in sorted(range(len(predictions)), key=lambda at: -levels[at]):
            azimuth, power = predictions[at][:2]
            step = self.step(levels[at])
            near = sorted((abs(azimuth - target[0]), k) for k, target in enumerate(truth))
            near = [(distance, k) for distance, k in near if distance <= HIT_DEG]
            for _, k in near:
                finders[k].append(step)
            if not near:
                self.wrong[step] += 1
                continue
            self.right[step] += 1
            self.angle[step] += near[0][0]
            self.power[step] += math.inf if power is None else abs(power - truth[near[0][1]][1])
            unmatched = [k for _, k in near if k in free]
            if unmatched:
                free.discard(unmatched[0])
                self.matched[step] += 1
        for steps in finders:
            if steps:
                self.found[min(steps)] += 1

    def at(self, step):
        """Scores at a threshold."""
        right, wrong, found, matched = (
            sum(counts[: step + 1]) for counts in (self.right, self.wrong, self.found, self.matched)
        )
        if right + wrong == 0:
            return None
        targets = max(self.targets, 1)

        def f1(hits, recalled):
            precision, recall = hits / (right + wrong), recalled / targets
            return 2 * precision * recall / (precision + recall) if hits else 0.0

        return {
            "precision": right / (right + wrong),
            "recall": found / targets,
            "f1": f1(right, found),
            "strictF1": f1(matched, matched),
            "angleErrorDeg": sum(self.angle[: step + 1]) / max(right, 1),
            "powerErrorDb": sum(self.power[: step + 1]) / max(right, 1),
        }

    def at_db(self, threshold_db):
        step = round((self.top_db - threshold_db) * STEPS_PER_DB) - 1
        return self.at(step) if step >= 0 else None

    def all(self):
        return [self.at(step) for step in range(STEPS)]


def aoa(lines, report, comparison):
    """Figures 4 and 5 of the AAETR paper, and the one threshold."""
    conditions = [(c["targets"], c["snrDb"]) for c in report["conditions"]]
    tallies = defaultdict(Tally)
    for line in lines:
        for method, predictions in line["answers"].items():
            tallies[line["condition"], method].add(line["truth"], predictions)
    for k, method in enumerate(report["methods"]):
        # The mean F1 over the conditions of the snapshots for the threshold is nowhere larger than at the one reported.
        others = [tallies[len(conditions) + c, method] for c in range(len(conditions))]
        f1 = [[point["f1"] if point else 0.0 for point in tally.all()] for tally in others]
        largest = max(sum(of_step) for of_step in zip(*f1, strict=True))
        one_db = report["thresholdsDb"][k]
        here = sum(point["f1"] for tally in others if (point := tally.at_db(one_db)))
        comparison.check(f"{method}, mean F1 at its threshold", here, largest)
        for c, (targets, snr_db) in enumerate(conditions):
            what = f"{method}, {targets} targets, {snr_db} dB"
            reported, tally = report["conditions"][c]["methods"][k], tallies[c, method]
            points = [point for point in tally.all() if point]
            comparison.check(f"{what}, largest F1", max(p["f1"] for p in points), reported["best"]["f1"])
            comparison.check(f"{what}, largest strict F1", max(p["strictF1"] for p in points), reported["strictF1"])
            for name, point, at_db in (
                ("at the largest F1", reported["best"], reported["best"]["thresholdDb"]),
                ("at one threshold", reported["atOneThreshold"], one_db),
            ):
                counted = tally.at_db(at_db) or {}
                for score in ("precision", "recall", "f1", "strictF1", "angleErrorDeg", "powerErrorDb"):
                    comparison.check(f"{what}, {score} {name}", counted.get(score), point and point[score])


class Answers:
    """Angles of one method in one condition."""

    def __init__(self):
        self.trials = self.found = self.close = self.success = self.close_success = 0
        self.squares = 0.0
        self.within, self.close_within = [0] * 3, [0] * 3

    def add(self, truth, angles):
        self.trials += 1
        close = len(truth) == 2 and truth[1] - truth[0] < CLOSE_DEG
        self.close += close
        if angles is None:
            return
        self.found += 1
        errors = [round(abs(a - t), 9) for a, t in zip(angles, truth, strict=True)]
        self.squares += sum((a - t) ** 2 for a, t in zip(angles, truth, strict=True))
        success = max(errors) <= SUCCESS_DEG
        self.success += success
        self.close_success += success and close
        # To the nearest whole degree, halves away from zero, and no further than targets go.
        whole = [math.copysign(math.floor(abs(round(a, 9)) + 0.5), a) for a in angles]
        whole = [min(max(a, -LARGEST_DEG), LARGEST_DEG) for a in whole]
        largest = max(abs(a - t) for a, t in zip(whole, truth, strict=True))
        for k, deviation in enumerate((0, 2, 4)):
            self.within[k] += largest <= deviation
            self.close_within[k] += largest <= deviation and close


def doa(lines, report, comparison):
    """Figures 6 to 9 of the 3D-CNN paper."""
    methods, counters = defaultdict(Answers), defaultdict(lambda: [0] * 4)
    for line in lines:
        condition = (line["targets"], line["snrDb"])
        for name, counted in line["counted"].items():
            counters[condition, name][min(counted, 3)] += 1
        if line["truthDeg"]:
            for name, angles in line["anglesDeg"].items():
                methods[condition, name].add(line["truthDeg"], angles)
    for c in report["conditions"]:
        condition = (c["targets"], c["snrDb"])
        for name, shares in zip(report["counters"], c["counted"], strict=True):
            for number, share in enumerate(shares):
                counted = counters[condition, name][number] / c["trials"]
                comparison.check(f"{condition}, {name}, counted {number}", counted, share)
        for name, reported in zip(report["methods"], c["methods"], strict=False):
            if reported is None:
                continue
            answers = methods[condition, name]
            angles = answers.found * (1 if c["targets"] == "one" else 2)
            pairs = [
                ("trials", answers.trials, c["trials"]),
                ("found", answers.found / answers.trials, reported["found"]),
                ("success", answers.success / answers.trials, reported["success"]),
                ("RMSE", math.sqrt(answers.squares / angles) if angles else None, reported["rmseDeg"]),
            ]
            of_all = zip(answers.within, reported["within"], strict=True)
            pairs += [("within", n / answers.trials, r) for n, r in of_all]
            if answers.close:
                of_close = zip(answers.close_within, reported["closeWithin"], strict=True)
                pairs += [("close success", answers.close_success / answers.close, reported["closeSuccess"])]
                pairs += [("close within", n / answers.close, r) for n, r in of_close]
            for what, counted, value in pairs:
                comparison.check(f"{condition}, {name}, {what}", counted, value)


def main():
    answers, report = sys.argv[1:]
    with open(report, encoding="utf-8") as file:
        report = json.load(file)
    comparison = Comparison()
    with open(answers, encoding="utf-8") as file:
        head = json.loads(file.readline())
        count = {"aoa": aoa, "doa": doa}[head["experiment"]]
        count((json.loads(line) for line in file), report, comparison)
    for line in comparison.wrong[:20]:
        print(line)
    print(f"{comparison.count} numbers counted again, {len(comparison.wrong)} differ")
    return 1 if comparison.wrong or not comparison.count else 0


if __name__ == "__main__":
    sys.exit(main())
