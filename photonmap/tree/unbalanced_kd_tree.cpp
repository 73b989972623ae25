#include "photonmap/tree/unbalanced_kd_tree.h"

#include <sys/mman.h>

#include "core/base/error.h"
#include "photonmap/tree/kd_search.h"

namespace caustics::photonmap {

namespace {

using Node = UnbalancedKdTree::Node;

/// Nodes are numbered from 1; 0 is none.
struct LinkedNodes {
    const Node* nodes;
    std::uint64_t first;

    std::uint64_t root() const { return first; }
    static bool exists(std::uint64_t node) { return node != 0; }
    const Photon& photon(std::uint64_t node) const { return nodes[node - 1].photon; }
    static std::uint32_t index(std::uint64_t node) { return static_cast<std::uint32_t>(node - 1); }
    std::uint64_t child(std::uint64_t node, bool right) const {
        return nodes[node - 1].children[right ? 1 : 0];
    }
};

bool same_place(const Photon& a, const Photon& b) {
    return a.position[0] == b.position[0] && a.position[1] == b.position[1] &&
           a.position[2] == b.position[2];
}

/// Memory as PhotonStore takes it, in large pages where the system has them, so that the trees
/// differ by their order alone.
void* map_memory(std::size_t bytes) {
    if (bytes == 0) return nullptr;
    void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED)
        throw InputError("photonmap: cannot reserve " + std::to_string(bytes) +
                         " bytes for the unbalanced tree (ask for fewer photons or emitted)");
    madvise(memory, bytes, MADV_HUGEPAGE);
    return memory;
}

}  // namespace

void UnbalancedKdTree::Unmap::operator()(Node* memory) const { munmap(memory, bytes); }

UnbalancedKdTree::UnbalancedKdTree(PhotonStore photons, Isa isa)
    : KdTreeBase(tree_kernels(isa), ArrivalDirections(photons.photons())),
      size_(photons.size()),
      nodes_(static_cast<Node*>(map_memory(size_ * sizeof(Node))), {size_ * sizeof(Node)}) {
    const std::span<const Photon> arrived = photons.photons();
    for (std::size_t i = 0; i < size_; ++i) {
        nodes_[i] = {arrived[i], {0, 0}};
        insert(static_cast<std::uint32_t>(i + 1));
    }
}

void UnbalancedKdTree::insert(std::uint32_t number) {
    Photon& photon = nodes_[number - 1].photon;
    unsigned axis = 0;
    std::uint64_t level = 1;
    if (number > 1) {
        for (std::uint32_t at = 1;; ++level) {
            Node& parent = nodes_[at - 1];
            bool right = photon.position[axis] >= parent.photon.position[axis];
            // Photons at one point, a perfect focus say, would make a list.
            if (right && same_place(photon, parent.photon))
                right = (number >> (level % 16) & 1U) != 0;
            axis = axis == 2 ? 0 : axis + 1;
            std::uint32_t& child = parent.children[right ? 1 : 0];
            if (child == 0) {
                child = number;
                ++level;
                break;
            }
            at = child;
        }
    }
    set_axis(photon, axis);
    depth_ = std::max(depth_, level);
    passed_ += level - 1;
}

void UnbalancedKdTree::find(const NearestQuery& query, GatherScratch& scratch) const {
    find_nearest(LinkedNodes{nodes_.get(), size_ == 0 ? 0U : 1U}, kernels_, query, scratch);
}

void UnbalancedKdTree::copy_out(const Candidates& found, const CopiedPhotons& to) const {
    for (std::size_t i = 0; i < found.count; ++i) copy_photon(nodes_[found.index[i]].photon, i, to);
}

std::uint64_t UnbalancedKdTree::code_of(std::uint32_t photon) const {
    return code(nodes_[photon].photon);
}

}  // namespace caustics::photonmap
