// The table of methods: what options, help pages and reports are made from.
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string_view>

#include "methods/methods.h"

namespace vitrail::tests {
namespace {

using namespace vitrail::tool;

TEST(MethodTable, EveryRowIsWhole) {
  std::set<std::string_view> names;
  for (const std::string_view name : methodNames()) {
    SCOPED_TRACE(name);
    const MethodTraits& traits = traitsOf(name);
    EXPECT_TRUE(names.insert(name).second) << "twice";
    EXPECT_EQ(traits.name, name);
    EXPECT_TRUE(traits.listed);
    EXPECT_NE(traits.make != nullptr, traits.onProcessor);
    EXPECT_FALSE(traits.help.empty());
    EXPECT_LE(traits.help.size(), 65U);
    EXPECT_TRUE(traits.orderIndependent || !traits.wrong.empty()) << "exact pictures know no order";
  }
  EXPECT_EQ(methodNames().front(), MethodOptions{}.name);
}

TEST(MethodTable, WhatIsNotListedCannotBeChosen) {
  EXPECT_FALSE(traitsOf(kLayerCount).listed);
  MethodOptions options;
  options.name = kLayerCount;
  EXPECT_THROW(checkMethodOptions(options), std::invalid_argument);
  EXPECT_THROW(traitsOf("painted"), std::logic_error);
}

} // namespace
} // namespace vitrail::tests
