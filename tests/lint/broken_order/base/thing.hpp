#pragma once

std::vector<int> thing();
