# cmake -DFOLDER=FOLDER -DNAME=NAME -DOUTPUT=HEADER -P embed_page.cmake: FOLDER/NAME.html, with
# NAME.css in the place of @STYLE@, and NAME_viewer.js and NAME.js in that of @SCRIPT@, becomes
# `static const unsigned char NAME_html[]`, with a zero behind it.
file(READ ${FOLDER}/${NAME}.html page)
file(READ ${FOLDER}/${NAME}.css style)
file(READ ${FOLDER}/${NAME}_viewer.js viewer)
file(READ ${FOLDER}/${NAME}.js script)
string(REPLACE "@STYLE@" "${style}" page "${page}")
string(REPLACE "@SCRIPT@" "${viewer}\n${script}" page "${page}")
file(WRITE ${OUTPUT}.html "${page}")
file(READ ${OUTPUT}.html bytes HEX)
string(REGEX REPLACE "(................................)" "\\1\n    " bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1, " bytes "${bytes}")
file(WRITE ${OUTPUT} "static const unsigned char ${NAME}_html[] = {\n    ${bytes}0};\n")
