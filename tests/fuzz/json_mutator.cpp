#include "tests/fuzz/json_mutator.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string_view>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace caustics::fuzz {
namespace {

using Json = nlohmann::ordered_json;

// What a writer of JSON can survive in depth; readers see deeper texts by nest().
constexpr int deepest = 80;

constexpr std::array extremes = {0.0,
                                 -0.0,
                                 1.0,
                                 -1.0,
                                 0.5,
                                 2.0,
                                 3.0,
                                 1e-300,
                                 5e-324,
                                 1e-30,
                                 1e-6,
                                 0.999999999,
                                 90.0,
                                 179.9999,
                                 360.0,
                                 1e6,
                                 16777217.0,
                                 2147483648.0,
                                 9007199254740993.0,
                                 9223372036854775808.0,
                                 1e17,
                                 5e17,
                                 1e19,
                                 1e30,
                                 1e31,
                                 3.5e38,
                                 1e150,
                                 1.7e308,
                                 -1e30,
                                 -5e17};

struct Place {
    Json* value;
    Json* parent;  ///< nullptr of the root
    int depth;
};

void collect(Json& value, Json* parent, int depth, std::vector<Place>& out) {
    out.push_back({&value, parent, depth});
    if (!value.is_structured()) return;
    for (auto& child : value) collect(child, &value, depth + 1, out);
}

std::optional<Json> parse(std::string_view text) {
    const auto bounded = [](int depth, Json::parse_event_t, Json&) { return depth < deepest; };
    Json value = Json::parse(text, bounded, false);
    if (value.is_discarded() || text.empty()) return {};
    return value;
}

class Mutation {
public:
    Mutation(Json& root, unsigned seed, const std::vector<std::string>& words)
        : root_(root), random_(seed), words_(words) {
        collect(root_, nullptr, 0, places_);
    }

    void apply() {
        Place& place = places_[below(places_.size())];
        switch (below(12)) {
            case 0: rename(place); break;
            case 1: *place.value = anything(); break;
            case 2: double_it(place); break;
            case 3: nest(*place.value); break;
            case 4: swap(place); break;
            case 5: remove(place); break;
            case 6: add_member(place); break;
            case 7: retype(place); break;
            default: change(place); break;
        }
    }

    std::size_t below(std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
    }

private:
    std::string word() {
        return words_.empty() || below(20) == 0 ? "x" : words_[below(words_.size())];
    }

    double number() { return extremes[below(extremes.size())]; }

    Json anything() {
        switch (below(9)) {
            case 0: return nullptr;
            case 1: return below(2) == 1;
            case 2: return word();
            case 3: return Json::array();
            case 4: return Json::object();
            case 5: return {number(), number(), number()};
            case 6: return static_cast<std::int64_t>(below(200)) - 20;
            case 7: return *places_[below(places_.size())].value;
            default: return number();
        }
    }

    Json* an_object() {
        for (int i = 0; i < 20; ++i) {
            Json* const value = places_[below(places_.size())].value;
            if (value->is_object() && !value->empty()) return value;
        }
        return nullptr;
    }

    void rename(const Place&) {
        Json* const object = an_object();
        if (object == nullptr) return;
        Json renamed = Json::object();
        const std::size_t chosen = below(object->size());
        std::size_t at = 0;
        for (auto& [key, value] : object->items()) renamed[at++ == chosen ? word() : key] = value;
        *object = std::move(renamed);
    }

    void double_it(const Place& place) {
        const Json copy = *place.value;
        if (place.parent == nullptr) return;
        const std::size_t times = below(20) == 0 ? 300 : 1;
        for (std::size_t i = 0; i < times; ++i) {
            if (place.parent->is_array())
                place.parent->push_back(copy);
            else
                (*place.parent)[word() + (i == 0 ? "" : std::to_string(i))] = copy;
            if (copy.size() > 100) return;
        }
    }

    void nest(Json& value) {
        for (std::size_t times = below(10) == 0 ? 70 : 1; times > 0; --times) {
            Json inner = std::move(value);
            if (below(2) == 1)
                value = Json::array({std::move(inner)});
            else
                value = Json{{word(), std::move(inner)}};
        }
    }

    void swap(const Place& place) {
        const Json other = *places_[below(places_.size())].value;
        *place.value = other;
    }

    void remove(const Place& place) {
        if (place.parent == nullptr) return;
        Json& parent = *place.parent;
        for (auto it = parent.begin(); it != parent.end(); ++it)
            if (&*it == place.value) {
                parent.erase(it);
                return;
            }
    }

    void add_member(const Place&) {
        if (Json* const object = an_object()) (*object)[word()] = anything();
    }

    void retype(const Place&) {
        Json* const object = an_object();
        if (object != nullptr && object->contains("type")) (*object)["type"] = word();
    }

    void change(const Place& place) {
        Json& value = *place.value;
        if (value.is_number()) {
            const double old = value.get<double>();
            switch (below(6)) {
                case 0: value = old * 2; break;
                case 1: value = -old; break;
                case 2: value = old * 1e-3; break;
                case 3: value = old + 1; break;
                case 4: value = static_cast<std::int64_t>(below(40)); break;
                default: value = number(); break;
            }
        } else if (value.is_boolean()) {
            value = !value.get<bool>();
        } else if (value.is_string()) {
            value = word();
        } else {
            value = anything();
        }
    }

    Json& root_;
    std::mt19937 random_;
    const std::vector<std::string>& words_;
    std::vector<Place> places_;
};

std::size_t hand_over(const std::string& text, std::uint8_t* data, std::size_t most) {
    const std::size_t size = std::min(text.size(), most);
    std::memcpy(data, text.data(), size);
    return size;
}

std::string dumped(const Json& value) {
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The first member of an object once more: the library's values cannot hold a key twice.
std::string with_a_key_twice(const std::string& text, Mutation& choice) {
    const std::size_t brace = text.find('{', choice.below(text.size()));
    const std::size_t comma = text.find(',', brace);
    if (brace == std::string::npos || comma == std::string::npos) return text;
    const std::string member = text.substr(brace + 1, comma - brace);
    return text.substr(0, brace + 1) + member + text.substr(brace + 1);
}

bool holds_much(const Json& value, double most) {
    if (value.is_array())
        return std::any_of(value.begin(), value.end(),
                           [&](const Json& each) { return holds_much(each, most); });
    return value.is_number() && value.get<double>() > most && value.get<double>() < 1e10;
}

bool asks_for_much(const Json& value, const std::map<std::string, double>& most) {
    if (value.is_object())
        for (const auto& [key, child] : value.items()) {
            const auto known = most.find(key);
            if (known != most.end() && holds_much(child, known->second)) return true;
        }
    return value.is_structured() && std::any_of(value.begin(), value.end(), [&](const Json& child) {
               return asks_for_much(child, most);
           });
}

}  // namespace

std::vector<std::string> words_of(const std::vector<ObjectText>& objects) {
    std::vector<std::string> words = {"$include", "type"};
    for (const ObjectText& object : objects) {
        words.push_back(object.name);
        for (const KeyText& key : object.keys) {
            words.push_back(key.key);
            std::istringstream choices(key.choices);
            for (std::string word; std::getline(choices, word, ',');)
                words.push_back(word.substr(std::min(word.find_first_not_of(' '), word.size())));
        }
    }
    const std::set<std::string> each(words.begin(), words.end());
    return {each.begin(), each.end()};
}

std::size_t mutate_json(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed,
                        const std::vector<std::string>& words) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    std::optional<Json> root = parse(text);
    if (!root || seed % 8 == 0) return LLVMFuzzerMutate(data, size, most);
    for (unsigned i = 0; i < 1 + seed % 3; ++i) Mutation(*root, seed + i, words).apply();
    std::string changed = dumped(*root);
    if (seed % 64 == 1) {
        Mutation choice(*root, seed, words);
        changed = with_a_key_twice(changed, choice);
    }
    return hand_over(changed, data, most);
}

std::size_t cross_json(const std::string& first, const std::string& second, std::uint8_t* out,
                       std::size_t most, unsigned seed) {
    std::optional<Json> into = parse(first);
    std::optional<Json> from = parse(second);
    if (!into || !from) return hand_over(first, out, most);
    std::vector<Place> targets;
    std::vector<Place> sources;
    collect(*into, nullptr, 0, targets);
    collect(*from, nullptr, 0, sources);
    std::mt19937 random(seed);
    const Json taken = *sources[random() % sources.size()].value;
    Place& target = targets[random() % targets.size()];
    if (target.value->is_object())
        (*target.value)["from" + std::to_string(random() % 4)] = taken;
    else
        *target.value = taken;
    return hand_over(dumped(*into), out, most);
}

bool asks_for_much(std::string_view text, const std::map<std::string, double>& most) {
    const std::optional<Json> value = parse(text);
    return value && asks_for_much(*value, most);
}

}  // namespace caustics::fuzz
