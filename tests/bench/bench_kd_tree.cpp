// The photon map's trees against nanoflann: building, and finding the nearest photons. Counters are
// nanoseconds per photon (build) or per query. Every contestant's every answer is compared with
// nanoflann's before anything is timed.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "photonmap/tree/build_tree.h"
#include "tests/bench/bench.h"
#include "tests/bench/contest.h"
#include "tests/bench/query_set.h"

namespace caustics::bench {

namespace {

using ResultSet = NanoflannTree::ResultSet;
using TreePointer = std::shared_ptr<const photonmap::PhotonTree>;

constexpr std::size_t few = 250'677;
constexpr std::size_t many = 5'036'126;
constexpr std::size_t usual_k = 100;
constexpr std::size_t default_leaf = 10;

TreePointer tree_of(photonmap::TreeKind kind, const std::vector<photonmap::Photon>& photons,
                    Isa isa) {
    return photonmap::build_tree(kind, store_of(photons), isa);
}

NanoflannTree nanoflann_of(const std::vector<photonmap::Photon>& photons, std::size_t leaf) {
    return {photons.front().position, photons.size(), sizeof(photonmap::Photon) / sizeof(float),
            leaf};
}

/// Trees over one set of photons.
struct Trees {
    TreePointer packed;
    TreePointer balanced;
    std::vector<NanoflannTree> nanoflann;  ///< one of each leaf size
    std::vector<std::size_t> leaf_sizes;
};

/// Those of the set asked for last are kept, for the next benchmark of the same set.
std::shared_ptr<const Trees> trees_of(Caustic caustic, std::size_t count,
                                      const BenchOptions& options) {
    static std::shared_ptr<const Trees> last;
    static std::pair<Caustic, std::size_t> last_set;
    if (last && last_set == std::pair(caustic, count)) return last;
    last.reset();
    const std::vector<photonmap::Photon>& photons = photons_of(caustic, Arrival::random, count);
    const auto trees = std::make_shared<Trees>();
    trees->packed = tree_of(photonmap::TreeKind::packed, photons, options.isa);
    trees->balanced = tree_of(photonmap::TreeKind::balanced, photons, options.isa);
    trees->leaf_sizes = options.quick ? std::vector<std::size_t>{default_leaf, 32}
                                      : std::vector<std::size_t>{default_leaf, 20, 32, 64};
    for (const std::size_t leaf : trees->leaf_sizes)
        trees->nanoflann.push_back(nanoflann_of(photons, leaf));
    last_set = {caustic, count};
    return last = trees;
}

/// The leaf size with which nanoflann answers these queries fastest: its number in the list.
std::size_t best_leaf(const Trees& trees, ResultSet set, const QuerySet& queries,
                      const photonmap::GatherLimits& limits) {
    std::size_t best = 0;
    std::chrono::steady_clock::duration least = std::chrono::steady_clock::duration::max();
    for (std::size_t i = 0; i < trees.nanoflann.size(); ++i) {
        Answers answers;
        const auto start = std::chrono::steady_clock::now();
        ask(trees.nanoflann[i], set, queries, limits, answers);
        const auto spent = std::chrono::steady_clock::now() - start;
        if (spent < least) best = i;
        least = std::min(least, spent);
    }
    return best;
}

/// A contest of queries, whose contestants' answers must be those of nanoflann.
class QueryContest {
public:
    QueryContest(QuerySet queries, const photonmap::GatherLimits& limits)
        : queries_(std::make_shared<const QuerySet>(std::move(queries))),
          limits_(limits),
          contest_(static_cast<double>(queries_->points.size())) {}

    void add_tree(const std::string& name, const TreePointer& tree) {
        const auto scratch = std::make_shared<photonmap::GatherScratch>();
        add(name, [=, queries = queries_, limits = limits_](Answers& answers) {
            ask(*tree, *queries, limits, *scratch, answers);
        });
    }
    /// nanoflann at its best leaf size. The first contestant tells the truth.
    void add_nanoflann(const std::string& name, const std::shared_ptr<const Trees>& trees,
                       ResultSet set) {
        const std::size_t best = best_leaf(*trees, set, *queries_, limits_);
        contest_.note(name + "_leaf", static_cast<double>(trees->leaf_sizes[best]));
        add(name, [=, queries = queries_, limits = limits_](Answers& answers) {
            ask(trees->nanoflann[best], set, *queries, limits, answers);
        });
    }
    void use_truth(Answers truth) { truth_ = std::move(truth); }
    const QuerySet& queries() const { return *queries_; }
    const photonmap::GatherLimits& limits() const { return limits_; }
    Contest take() { return std::move(contest_); }

private:
    void add(const std::string& name, const std::function<void(Answers&)>& ask_all) {
        const auto answers = std::make_shared<Answers>();
        ask_all(*answers);
        if (!truth_) truth_ = *answers;
        require_same(*answers, *truth_, name);
        contest_.add(name, [answers, ask_all] { ask_all(*answers); });
    }

    std::shared_ptr<const QuerySet> queries_;
    photonmap::GatherLimits limits_;
    std::optional<Answers> truth_;
    Contest contest_;
};

Contest knn_contest(Caustic caustic, std::size_t count, std::size_t k, Density density,
                    const BenchOptions& options) {
    const std::shared_ptr<const Trees> trees = trees_of(caustic, count, options);
    QueryContest contest(make_queries(caustic, density, options.quick),
                         limits_of(caustic, k, count));
    contest.add_nanoflann("nanoflann", trees, ResultSet::stock);
    contest.add_nanoflann("nanoflann_heap", trees, ResultSet::heap);
    contest.add_tree("packed", trees->packed);
    contest.add_tree("balanced", trees->balanced);
    return contest.take();
}

Contest build_contest(Caustic caustic, std::size_t count, const BenchOptions& options) {
    // The leaf size that nanoflann builds fastest with, of those that its queries like.
    constexpr std::size_t leaf = 32;
    const std::vector<photonmap::Photon>& photons = photons_of(caustic, Arrival::random, count);
    Contest contest(static_cast<double>(count));
    const auto nanoflann = std::make_shared<std::optional<NanoflannTree>>();
    contest.add(
        "nanoflann", [&photons, nanoflann] { nanoflann->emplace(nanoflann_of(photons, leaf)); },
        [nanoflann] { nanoflann->reset(); });
    for (const photonmap::TreeKind kind :
         {photonmap::TreeKind::balanced, photonmap::TreeKind::packed}) {
        const auto store = std::make_shared<std::optional<photonmap::PhotonStore>>();
        const auto tree = std::make_shared<std::unique_ptr<const photonmap::PhotonTree>>();
        contest.add(
            name(kind),
            [=] { *tree = photonmap::build_tree(kind, std::move(**store), options.isa); },
            [&photons, store, tree] {
                tree->reset();
                store->emplace(store_of(photons));
            });
    }
    return contest;
}

/// The same queries on a small map and on one twenty times as large.
Contest cost_contest(Caustic caustic, const BenchOptions& options) {
    Contest contest(1);
    const auto queries =
        std::make_shared<const QuerySet>(make_queries(caustic, Density::sparse, options.quick));
    for (const std::size_t count : {few, many})
        for (const photonmap::TreeKind kind :
             {photonmap::TreeKind::packed, photonmap::TreeKind::balanced}) {
            const TreePointer tree =
                tree_of(kind, photons_of(caustic, Arrival::random, count), options.isa);
            const auto scratch = std::make_shared<photonmap::GatherScratch>();
            const auto answers = std::make_shared<Answers>();
            const photonmap::GatherLimits limits = limits_of(caustic, usual_k, count);
            contest.add(std::string(name(kind)) + (count == few ? "_250k" : "_5M"),
                        [=] { ask(*tree, *queries, limits, *scratch, *answers); });
        }
    return contest;
}

Contest unbalanced_contest(Caustic caustic, std::size_t count, Arrival arrival,
                           const BenchOptions& options) {
    const std::vector<photonmap::Photon>& photons = photons_of(caustic, arrival, count);
    QueryContest contest(make_queries(caustic, Density::sparse, options.quick),
                         limits_of(caustic, usual_k, count));
    Answers truth;
    ask(nanoflann_of(photons, default_leaf), ResultSet::heap, contest.queries(), contest.limits(),
        truth);
    contest.use_truth(std::move(truth));
    contest.add_tree("balanced", tree_of(photonmap::TreeKind::balanced, photons, options.isa));
    contest.add_tree("unbalanced", tree_of(photonmap::TreeKind::unbalanced, photons, options.isa));
    return contest.take();
}

void register_knn(Caustic caustic, std::size_t count, const BenchOptions& options) {
    const std::string set = std::string(name(caustic)) + "/" + std::to_string(count) + "/";
    for (const Density density : {Density::sparse, Density::dense})
        for (const std::size_t k : {50U, 100U, 200U})
            if (!options.quick || k == usual_k)
                register_contest("knn/" + set + std::to_string(k) + "/" + name(density), 1,
                                 [=] { return knn_contest(caustic, count, k, density, options); });
    if (count == few)
        register_contest("tile/" + set + "100", 1, [=] {
            return knn_contest(caustic, count, usual_k, Density::tiles, options);
        });
}

void register_unbalanced(Caustic caustic, std::size_t count, const BenchOptions& options) {
    for (const Arrival arrival :
         {Arrival::random, Arrival::shuffled_strata, Arrival::r2, Arrival::scanline_strata}) {
        // Rows of strata make a tree a thousand levels deep: with many photons it takes minutes.
        if (arrival == Arrival::scanline_strata && count == many) continue;
        register_contest("unbalanced/" + std::string(name(caustic)) + "/" + std::to_string(count) +
                             "/" + name(arrival),
                         1, [=] { return unbalanced_contest(caustic, count, arrival, options); });
    }
}

}  // namespace

void register_benchmarks(const BenchOptions& options) {
    for (const Caustic caustic : {Caustic::water, Caustic::ball}) {
        for (const std::size_t count : {few, many}) {
            if (options.quick && count == many) continue;
            register_knn(caustic, count, options);
            register_unbalanced(caustic, count, options);
        }
        const std::size_t built = options.quick ? few : many;
        register_contest("build/" + std::string(name(caustic)) + "/" + std::to_string(built), 1,
                         [=] { return build_contest(caustic, built, options); });
        if (!options.quick)
            register_contest("cost/" + std::string(name(caustic)), 1,
                             [=] { return cost_contest(caustic, options); });
    }
}

}  // namespace caustics::bench
