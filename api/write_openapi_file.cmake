# Writes openapi_file.cpp: the text of openapi.json as raw string literals, in pieces that any compiler takes.
file(READ ${SOURCE} text)
string(LENGTH "${text}" length)
set(literals)
set(at 0)
while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 piece)
    string(APPEND literals "R\"openapi(${piece})openapi\"\n")
    math(EXPR at "${at} + 8000")
endwhile()
file(WRITE ${OUT}
    "#include \"api/openapi_file.h\"\n\n"
    "std::string_view api::openapi_file()\n{\n    return\n${literals};\n}\n")
