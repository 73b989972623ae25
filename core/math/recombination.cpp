#include "core/math/recombination.h"

#include <algorithm>
#include <cmath>
#include <Eigen/QR>
#include <limits>

namespace caustics {
namespace {

// A change of weights, for one column more than there are rows, of which no sum is aware.
Eigen::VectorXd unseen_change(const Eigen::MatrixXd& columns) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns.transpose());
    return qr.householderQ() * Eigen::VectorXd::Unit(columns.cols(), columns.cols() - 1);
}

// How far weights may go along a change until one of them is 0.
double room(const Eigen::VectorXd& weights, const Eigen::VectorXd& change) {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < weights.size(); ++i)
        if (change[i] < 0) least = std::min(least, weights[i] / -change[i]);
    return least;
}

// One way or the other, by chances that leave each weight as it is on average, until one is 0.
void exchange(Eigen::VectorXd& weights, const Eigen::VectorXd& change, Rng& rng) {
    const double forth = room(weights, change);
    const double back = room(weights, -change);
    const double draw = rng.next_fine() * (forth + back);
    // Where the change has but one sign, the values of all that it changes are 0 but for rounding.
    const bool goes_forth = std::isfinite(forth + back) ? draw < back : forth < back;
    const Eigen::VectorXd step = goes_forth ? Eigen::VectorXd(forth * change) : -back * change;
    Eigen::Index first = 0;
    ((weights + step).array() / step.array().abs().max(std::numeric_limits<double>::min()))
        .minCoeff(&first);
    weights = (weights + step).cwiseMax(0);
    weights[first] = 0;
}

// Leaves as many factors above 0 as there are rows.
void reduce(Eigen::VectorXd& factors, const Eigen::MatrixXd& columns, Rng& rng) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index next = 0; next < factors.size(); ++next) {
        kept.push_back(next);
        if (std::ssize(kept) <= columns.rows()) continue;
        Eigen::VectorXd some = factors(kept);
        exchange(some, unseen_change(columns(Eigen::all, kept)), rng);
        factors(kept) = some;
        std::erase_if(kept, [&](Eigen::Index i) { return factors[i] == 0; });
    }
}

// Multiplies the weights of each of some groups of neighbours by one factor, 0 for half of the groups.
void reduce_groups(std::vector<double>& weights, const std::vector<Eigen::Index>& kept,
                   const Eigen::MatrixXd& values, Rng& rng) {
    const auto points = std::ssize(kept);
    const Eigen::Index groups = std::min(points, 2 * values.rows());
    const auto group_of = [&](Eigen::Index i) { return i * groups / points; };
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(values.rows(), groups);
    for (Eigen::Index i = 0; i < points; ++i) {
        const Eigen::Index point = kept[static_cast<std::size_t>(i)];
        columns.col(group_of(i)) += weights[static_cast<std::size_t>(point)] * values.col(point);
    }
    Eigen::VectorXd factors = Eigen::VectorXd::Ones(groups);
    reduce(factors, columns, rng);
    for (Eigen::Index i = 0; i < points; ++i)
        weights[static_cast<std::size_t>(kept[static_cast<std::size_t>(i)])] *=
            factors[group_of(i)];
}

}  // namespace

void recombine(std::vector<double>& weights, const Eigen::MatrixXd& values, Rng& rng) {
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] > 0) kept.push_back(static_cast<Eigen::Index>(i));
    while (std::ssize(kept) > values.rows()) {
        reduce_groups(weights, kept, values, rng);
        std::erase_if(kept,
                      [&](Eigen::Index i) { return weights[static_cast<std::size_t>(i)] == 0; });
    }
}

}  // namespace caustics
