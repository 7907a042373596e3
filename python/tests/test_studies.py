"""Comparisons and the laboratory: the numbers of the program, as data frames and figures."""

import json
import pickle
import subprocess

import numpy as np
import pytest

import freepath as fp

pytest.importorskip("pandas")

TIMES = {"convergence", "seconds", "cpu_seconds", "nanoseconds_per_lookup", "efficiency", "findings"}
ORIGIN = {"target", "command", "machine", "date", "references"}


def without_times(data):
    """What does not depend on the machine's speed, nor on who asks."""
    if isinstance(data, dict):
        return {k: without_times(v) for k, v in data.items() if k not in TIMES | ORIGIN}
    if isinstance(data, list):
        return [without_times(value) for value in data]
    return data


def run(program, *arguments):
    subprocess.run([program, *map(str, arguments)], check=True, capture_output=True)


def small_scene(field):
    component = fp.Component(field, sigma_s=[0.5, 0.75, 1], sigma_a=0.125, phase=0.5)
    return fp.Scene.around(component, size=(24, 16), environment=1.0)


HOW = {"spp": 8, "repeats": 2, "reference_spp": 16}


@pytest.fixture
def comparison(cloud):
    return fp.compare(small_scene(cloud), trackers=["delta", "weighted-delta"], **HOW)


def test_comparisons_have_the_numbers_of_the_program(program, cloud, tmp_path):
    cloud.save(tmp_path / "cloud.vdb")
    methods = {
        "trackers": ["delta", "regular", "ray-marching:step=2"],
        "estimators": ["ratio", "delta"],
    }
    found = fp.compare(small_scene(cloud), **methods, seed=3, **HOW)
    run(
        program, "compare", tmp_path / "cloud.vdb", "-o", tmp_path / "report", "--size", "24x16",
        "--environment", 1, "--sigma-s", "0.5,0.75,1", "--sigma-a", 0.125, "--g", 0.5,
        "--trackers", "delta,regular,ray-marching:step=2", "--transmittance", "ratio,delta",
        "--spp", 8, "--repeats", 2, "--reference-spp", 16, "--cache", "none", "--seed", 3,
    )  # fmt: skip
    theirs = json.loads((tmp_path / "report/compare.json").read_text())
    assert len(theirs["configurations"]) == 6
    assert without_times(found.data) == without_times(theirs)


def test_comparisons_of_files_have_the_numbers_of_the_program(program, tmp_path):
    path = tmp_path / "scene.pbrt"
    path.write_text("""
        LookAt 0 0 -4  0 0 0  0 1 0
        Camera "perspective"
        Film "rgb" "integer xresolution" 16 "integer yresolution" 12
        Sampler "sobol" "integer pixelsamples" 4
        WorldBegin
        LightSource "infinite" "rgb L" [ 1 0.5 0.25 ]
        MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 1 2 3 ] "rgb sigma_a" [ 0 0 0 ]
        AttributeBegin
          MediumInterface "fog" ""
          Material "interface"
          Shape "sphere"
        AttributeEnd
    """)
    found = fp.compare(fp.Scene.from_pbrt(path), trackers=["auto", "weighted-delta"], **HOW)
    run(
        program, "compare", path, "-o", tmp_path / "report", "--trackers", "auto,weighted-delta",
        "--spp", 8, "--repeats", 2, "--reference-spp", 16, "--cache", "none",
    )  # fmt: skip
    theirs = json.loads((tmp_path / "report/compare.json").read_text())
    assert without_times(found.data) == without_times(theirs)


def test_comparisons_are_data_frames(comparison):
    table = comparison.table
    assert list(table.index) == ["delta", "weighted-delta"]
    assert (table["bias_test"] == "passes").all()
    assert table["efficiency"]["delta"] == 1
    assert ((table["mse_low"] < table["mse"]) & (table["mse"] < table["mse_high"])).all()
    runs = comparison.runs
    assert runs.shape[0] == 4 and (runs["samples"] == 4).all()
    assert np.isclose(runs["mse"].groupby("name").mean()["delta"], table["mse"]["delta"], rtol=1e-12)
    assert np.allclose(runs[["mse_r", "mse_g", "mse_b"]].mean(axis=1), runs["mse"])
    points = comparison.convergence
    # Which passes are looked at depends on when they end.
    assert list(points.columns) == ["name", "run", "samples", "seconds", "mse"]
    assert set(points["name"]) == {"delta", "weighted-delta"} and points["samples"].max() == 4
    assert "<table" in comparison._repr_html_()


def test_comparisons_are_drawn_and_written(comparison, tmp_path):
    pytest.importorskip("matplotlib")
    figure = comparison.figure()
    figure.savefig(tmp_path / "figure.png")
    assert len(figure.axes) == 2 and len(figure.axes[1].lines) == 2
    comparison.save(tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text()
    assert "weighted-delta" in page and "freepath.compare" in page
    assert [path.name for path in tmp_path.glob(".*")] == []
    with pytest.raises(fp.Error, match="nowhere"):
        comparison.save(tmp_path / "nowhere" / "report.html")


def test_comparisons_are_pickled(comparison):
    again = pickle.loads(pickle.dumps(comparison))
    assert again.data == comparison.data
    assert again.table.equals(comparison.table)
    with pytest.raises(fp.Error, match="damaged"):
        fp._freepath.comparison_of_bytes(fp._freepath.comparison_bytes(comparison._core)[:-1])


def test_a_biased_method_is_found_out(cloud):
    medium = fp.Component(cloud, sigma_s=1, sigma_a=0.5)
    scene = fp.Scene.around(medium, size=(24, 16), environment=1.0)
    found = fp.compare(
        scene, trackers=["delta", "ray-marching:step=8"], spp=128, repeats=4, reference_spp=256
    )
    assert list(found.table["bias_test"]) == ["passes", "fails"]
    assert any("biased" in finding for finding in found.findings)


def test_references_are_kept_where_that_is_wished(cloud, tmp_path):
    def origin(scene, **how):
        found = fp.compare(scene, trackers="delta", cache=tmp_path, **{**HOW, **how})
        return found.data["references"][0]["origin"].split()[0]

    assert origin(small_scene(cloud)) == "made"
    assert origin(small_scene(cloud), seed=1) == "found"
    assert origin(small_scene(cloud), max_scatterings=2) == "made"
    assert origin(fp.Scene.around(cloud, size=(24, 16), environment=1.0)) == "made"


def test_comparisons_tell_their_progress_and_end(cloud):
    seen = []

    def watch(step, fraction):
        seen.append((step, fraction))
        return len(seen) < 3

    with pytest.raises(fp.Error, match="interrupted"):
        fp.compare(small_scene(cloud), time=100, progress=watch)
    assert seen[-1][0] == "reference" or "run 1 of 5" in seen[-1][0]
    assert all(0 <= fraction <= 1 for _, fraction in seen)


COMPARISONS = {
    "unknown": (dict(trackers="dleta"), "no method 'dleta'"),
    "twice": (dict(trackers=["delta", "delta"]), "trackers: delta is given twice"),
    "none": (dict(trackers=[]), "no methods"),
    "refused": (dict(trackers="closed-form", spp=16), "closed-form: "),
    "interpolation": (dict(interpolations="cubic"), "cubic"),
    "time": (dict(time=0), "time: 0 is no positive"),
    "few": (dict(spp=4), "4 samples for 5 repeats"),
    "repeats": (dict(repeats=0), "repeats"),
    "both": (dict(reference="a.exr", reference_spp=4), "not for one given"),
    "no file": (dict(reference="missing.exr", spp=16), "missing.exr"),
}


@pytest.mark.parametrize("options, message", COMPARISONS.values(), ids=COMPARISONS.keys())
def test_bad_comparisons_have_one_clear_error(cloud, options, message):
    with pytest.raises(fp.Error, match=message):
        fp.compare(small_scene(cloud), **{"reference_spp": 4, **options} if "reference" not in options else options)


@pytest.fixture(scope="module")
def found():
    return fp.lab(["ramp", "chromatic-ramp"], trackers=["delta", "spectral:rate-scale=2"], paths=2e4)


def test_the_laboratory_has_the_numbers_of_the_program(program, found, tmp_path):
    run(
        program, "lab", "ramp", "chromatic-ramp", "-o", tmp_path, "--trackers",
        "delta,spectral:rate-scale=2", "--paths", "2e4",
    )  # fmt: skip
    theirs = json.loads((tmp_path / "lab.json").read_text())
    assert without_times(found.data) == without_times(theirs)
    assert [setting["name"] for setting in theirs["settings"]] == ["ramp", "chromatic-ramp"]


def test_the_laboratory_gives_data_frames(found):
    verdicts = found.verdicts
    assert (verdicts["verdict"] == "agrees").all() and verdicts.shape[0] == 4
    table = found.table
    one = table[(table["setting"] == "ramp") & (table["tracker"] == "delta")]
    through = one[one["quantity"] == "transmittance"].iloc[0]
    assert abs(through["value"] - through["exact"]) < 4.5 * through["standard_error"]
    entry = found.data["settings"][0]["trackers"][0]["channels"][0]["transmittance"]
    assert through["value"] == pytest.approx(entry["estimate"], rel=1e-8)


def test_the_laboratory_is_drawn_and_written(found, tmp_path):
    pytest.importorskip("matplotlib")
    figure = found.figure("chromatic-ramp", "scattered", trackers="spectral:rate-scale=2")
    figure.savefig(tmp_path / "figure.png")
    assert len(figure.axes) == 3 and len(figure.axes[0].lines) == 2
    for arguments, message in [
        (("spike",), "nothing of the setting"),
        (("ramp", "radiance"), "collision_density.*scattered"),
        (("ramp", "scattered", "regular"), "nothing of the trackers"),
    ]:
        with pytest.raises(fp.Error, match=message):
            found.figure(*arguments[:2], trackers=arguments[2] if arguments[2:] else None)
    found.save(tmp_path / "report")
    names = {path.name for path in (tmp_path / "report").iterdir()}
    assert {"report.html", "lab.json", "lab.csv"} <= names
    assert json.loads((tmp_path / "report/lab.json").read_text()) == found.data


def test_the_laboratory_refuses_what_is_not_there():
    assert "fixture-a" in fp.lab_settings()
    for options, message in [
        (dict(settings="rmap"), "there are: .*ramp"),
        (dict(settings=["ramp", "ramp"]), "twice"),
        (dict(settings="ramp", trackers="dleta"), "dleta"),
        (dict(paths=10), "paths"),
        (dict(absorption="none"), "none"),
    ]:
        with pytest.raises(fp.Error, match=message):
            fp.lab(**options)
    with pytest.raises(fp.Error):
        fp.lab("ramp", paths=1e9, progress=lambda step, fraction: False)


def test_without_pandas_the_error_says_what_to_install(comparison, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(fp.Error, match=r"pip install 'freepath\[reports\]'"):
        comparison.table
