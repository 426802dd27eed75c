"""The corrector on other people's discretisations."""

import gelbench as gb
import numpy as np
import pytest
from gelbench import corrector

sparse = pytest.importorskip("scipy.sparse")


def parabola():
    return corrector.Condition("parabola", lambda u: u[1] - u[0] ** 2, lambda u: np.array([[-2 * u[0], 1.0]]))


def test_the_nearest_point_of_a_parabola_is_found_with_its_multiplier():
    found = corrector.correct([0.0, 2.0], [parabola()], start=[1.0, 1.0])
    assert found.field == pytest.approx([np.sqrt(1.5), 1.5], abs=1e-8)
    # u − ū + ζ ∂c/∂u = 0
    assert found.multipliers["parabola"] == pytest.approx([0.5], abs=1e-8)


def test_matrices_of_any_kind_give_the_same_field():
    rng = np.random.default_rng(1)
    data, matrix, right = rng.normal(size=40), rng.normal(size=(7, 40)), rng.normal(size=7)
    exact = data - matrix.T @ np.linalg.solve(matrix @ matrix.T, matrix @ data - right)
    kinds = [matrix, np.asfortranarray(matrix), matrix.astype(">f8")]
    kinds += [sparse.csr_matrix(matrix), sparse.csc_array(matrix), sparse.coo_array(matrix)]
    for own in kinds:
        found = corrector.correct(data, [corrector.linear("rows", own, right)])
        assert found.field == pytest.approx(exact, abs=1e-12)


def test_known_values_and_weights():
    data = np.array([1.0, 2.0, 3.0, 4.0])
    mean = corrector.linear("sum", np.ones((1, 4)), [20.0])
    found = corrector.correct(data, [corrector.prescribed("first", 4, {0: 0.0}), mean], weights=[1.0, 1.0, 2.0, 4.0])
    assert found.field[0] == pytest.approx(0.0, abs=1e-12)
    # What is lacking is shared in proportion to 1/w.
    assert found.field[1:] - data[1:] == pytest.approx(11.0 * np.array([4.0, 2.0, 1.0]) / 7.0)


def test_a_parameter_without_data_is_estimated_with_its_error():
    rng = np.random.default_rng(2)
    x = np.linspace(0.0, 1.0, 200)
    data = np.append(3.0 * x + rng.normal(scale=0.1, size=x.size), 0.0)
    line = sparse.hstack([sparse.eye(x.size), -x[:, None]])
    weights = np.append(np.ones(x.size), 0.0)
    found = corrector.correct(data, [corrector.linear("line", line, np.zeros(x.size))], weights=weights, estimate=[x.size])
    slope = found.estimates[x.size]
    least_squares = (x @ data[:-1]) / (x @ x)
    assert slope.value == pytest.approx(least_squares, rel=1e-9)
    assert slope.interval[0] < 3.0 < slope.interval[1]
    assert slope.standard_error == pytest.approx(0.1 / np.sqrt(x @ x), rel=0.15)


def test_rows_that_depend_on_each_other_are_named():
    twice = np.array([[1.0, 1.0, 0.0], [2.0, 2.0, 0.0]])
    with pytest.raises(gb.SolveError, match="twice"):
        corrector.correct([1.0, 2.0, 3.0], [corrector.linear("twice", twice, [1.0, 3.0])])


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: corrector.correct([1.0, np.nan], [parabola()]),
        lambda: corrector.correct([[1.0, 2.0]], [parabola()]),
        lambda: corrector.correct([1.0, 2.0], [parabola()], weights=[1.0]),
        lambda: corrector.correct([1.0, 2.0], [parabola()], weights=[1.0, -1.0]),
        lambda: corrector.correct([1.0, 2.0], [parabola()], estimate=[2]),
        lambda: corrector.correct([1.0, 2.0], [parabola()], solver="best"),
        lambda: corrector.correct([1.0, 2.0], [corrector.Condition("c", lambda u: u[:1], np.ones((1, 3)))]),
        lambda: corrector.correct([1.0, 2.0], [corrector.Condition("c", lambda u: u[:1], np.full((1, 2), np.nan))]),
        lambda: corrector.prescribed("c", 2, {2: 1.0}),
    ],
)
def test_shapes_that_do_not_fit_are_refused(wrong):
    with pytest.raises(gb.InputError):
        wrong()


def test_what_a_condition_raises_comes_out():
    def fails(u):
        raise LookupError("no such field")

    with pytest.raises(LookupError):
        corrector.correct([1.0, 2.0], [corrector.Condition("c", lambda u: u[:1], fails)])


def test_a_jacobian_is_checked_by_differences():
    assert parabola().check([1.0, 2.0]) < 1e-8
    wrong = corrector.Condition("wrong", lambda u: u[1] - u[0] ** 2, lambda u: np.array([[2 * u[0], 1.0]]))
    assert wrong.check([1.0, 2.0]) > 0.1


def of_entries(indptr, indices):
    matrix = sparse.csr_matrix(np.ones((2, 2)))
    matrix.indptr, matrix.indices = np.array(indptr, dtype=np.int32), np.array(indices, dtype=np.int32)
    return matrix


@pytest.mark.parametrize(
    "matrix",
    [
        of_entries([0, 2, 4], [0, 1, 0, 7]),
        of_entries([0, 2, 4], [0, -1, 0, 1]),
        of_entries([0, 2, 9], [0, 1, 0, 1]),
        of_entries([0, 3, 2], [0, 1, 0, 1]),
        of_entries([-1, 2, 4], [0, 1, 0, 1]),
    ],
)
def test_matrices_whose_entries_lie_nowhere_are_refused(matrix):
    with pytest.raises(gb.InputError, match="conditions.*`c`"):
        corrector.correct([1.0, 2.0], [corrector.Condition("c", lambda u: u, lambda u: matrix)])


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        (lambda: corrector.correct([1.0, 2.0], [parabola()], weights=[0.0, 0.0]), "weights"),
        (lambda: corrector.correct([1.0, 2.0], [parabola(), parabola()]), "conditions.*`parabola`"),
        (lambda: corrector.correct([1.0, 2.0], [corrector.Condition("c", lambda u: [np.nan], np.ones((1, 2)))]), "`c`"),
        (lambda: corrector.correct([1.0, 2.0], [corrector.Condition("c", lambda u: None, np.ones((1, 2)))]), "`c`"),
        (lambda: corrector.correct([1.0, 2.0], [parabola()], estimate=[0.9]), "estimate"),
        (lambda: corrector.correct([1.0, 2.0], [parabola()], max_steps=-1), "max_steps"),
        (lambda: corrector.correct([1.0, 2.0], [parabola()], tolerance=np.nan), "tolerance"),
        (lambda: corrector.Condition("c", lambda u: u, np.eye(2), unknowns=[0.9, 1.9]), "unknowns of `c`"),
        (lambda: corrector.prescribed("c", 2, {0.7: 1.0}), "known"),
    ],
)
def test_what_is_wrong_is_named(wrong, named):
    with pytest.raises(gb.InputError, match=named):
        wrong()


def test_as_many_conditions_as_unknowns_need_no_weights():
    square = corrector.Condition("c", lambda u: u - 1.0, np.eye(2), unknowns=[0, 1])
    assert corrector.correct([0.0, 0.0], [square], weights=[0.0, 0.0]).field == pytest.approx([1.0, 1.0])


def test_correlated_errors_are_weighted_by_the_inverse_of_their_covariance():
    rng = np.random.default_rng(3)
    data, matrix, right = rng.normal(size=30), rng.normal(size=(5, 30)), rng.normal(size=5)
    apart = np.subtract.outer(np.arange(30), np.arange(30))
    covariance = np.exp(-0.5 * (apart / 2.0) ** 2) + 0.1 * np.eye(30)
    gain = covariance @ matrix.T @ np.linalg.inv(matrix @ covariance @ matrix.T)
    exact = data - gain @ (matrix @ data - right)
    found = corrector.correct(data, [corrector.linear("rows", matrix.tolist(), right)], covariance=covariance.tolist(), estimate=[4])
    assert found.field == pytest.approx(exact, abs=1e-9)
    assert found.multipliers["rows"] == pytest.approx(np.linalg.solve(matrix @ covariance @ matrix.T, matrix @ data - right), abs=1e-8)
    assert list(found.multipliers) == ["rows"]
    # The variance of the data's scale follows from their residuals.
    factor = (data - exact) @ np.linalg.solve(covariance, data - exact) / 5
    spread = np.sqrt(factor * (covariance - gain @ matrix @ covariance)[4, 4])
    assert found.estimates[4].value == pytest.approx(exact[4]) and found.estimates[4].standard_error == pytest.approx(spread, rel=1e-6)
    diagonal = corrector.correct([0.0, 2.0], [parabola()], start=[1.0, 1.0], covariance=[[1.0, 0.0], [0.0, 0.25]])
    weighted = corrector.correct([0.0, 2.0], [parabola()], start=[1.0, 1.0], weights=[1.0, 4.0])
    assert diagonal.field == pytest.approx(weighted.field, abs=1e-7)
    exact = corrector.correct([0.0, 2.0], [parabola()], start=[1.0, 1.0], covariance=[[1e-12, 0.0], [0.0, 0.25e-12]])
    assert exact.field == pytest.approx(diagonal.field, abs=1e-7)
    assert exact.multipliers["parabola"] == pytest.approx(1e12 * diagonal.multipliers["parabola"], rel=1e-5)
    for wrong, words in (([[1.0, 0.5], [0.0, 1.0]], "not symmetric"), ([[1.0, 2.0], [2.0, 1.0]], "positive definite"), ([1.0, 1.0], "covariance")):
        with pytest.raises(gb.InputError, match=words):
            corrector.correct([0.0, 2.0], [parabola()], covariance=wrong)


def test_a_dense_solver_that_no_memory_holds_is_refused():
    mean = corrector.Condition("mean", lambda u: [u.sum()], sparse.csr_matrix(np.ones((1, 40_000))))
    with pytest.raises(gb.InputError, match="13 GB"):
        corrector.correct(np.zeros(40_000), [mean], solver="dense")
