# Writes a C++ source that holds a text file. Split into pieces, because compilers limit the length of
# one literal (65,536 characters in the standard).
file(READ "${INPUT}" text)
string(LENGTH "${text}" length)
set(pieces "")
set(at 0)
while(at LESS length)
  string(SUBSTRING "${text}" ${at} 8000 piece)
  string(APPEND pieces "R\"__text__(${piece})__text__\"\n")
  math(EXPR at "${at} + 8000")
endwhile()
file(WRITE "${OUTPUT}" "#include \"${HEADER}\"\n\nnamespace skyhalo {\n\nextern const std::string_view "
                       "${VARIABLE};\nconst std::string_view ${VARIABLE} =\n${pieces};\n\n}  // namespace skyhalo\n")
