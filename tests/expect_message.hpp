// EXPECT_MESSAGE(statement, Type, "part"): the statement throws Type, and its message holds that part.
#pragma once

#include <gtest/gtest.h>

#define EXPECT_MESSAGE(statement, Type, part)                                           \
  try {                                                                                 \
    statement;                                                                          \
    ADD_FAILURE() << "nothing thrown";                                                  \
  } catch (const Type& error) {                                                         \
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what(); \
  }
