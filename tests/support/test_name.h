#pragma once

#include <gtest/gtest.h>

#include <string>

namespace caustics::support {

/// Suite and name of the running test, fit for a file's name.
inline std::string test_name() {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "-" + test->name();
    for (char& c : name)
        if (c == '/') c = '-';
    return name;
}

}  // namespace caustics::support
