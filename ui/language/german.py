"""German texts of the interface by their English ones; places in {braces} stay as they are."""

from __future__ import annotations

TEXTS = {
    # pencil and its lines
    "Merge to One Line": "Zu einer Linie verbinden",
    "Make one line of the selected strokes, in the middle of them; pencil strokes stay": (
        "Aus den ausgewählten Strichen eine Linie in ihrer Mitte machen; Bleistiftstriche bleiben"
    ),
    "Split into Pencil Strokes": "In Bleistiftstriche zerlegen",
    "Put the pencil strokes that say a line in its place, for all selected lines": (
        "Alle ausgewählten Linien durch die Bleistiftstriche ersetzen, aus denen sie wurden"
    ),
    "Select two or more strokes that are one line.": (
        "Wähle zwei oder mehr Striche aus, die eine Linie sind."
    ),
    "Select lines that were made of pencil strokes.": (
        "Wähle Linien aus, die aus Bleistiftstrichen wurden."
    ),
    # tracing
    "Trace Drawing": "Zeichnung nachziehen",
    "Turn a scanned drawing into Grease Pencil strokes that run straight through junctions": (
        "Aus einer gescannten Zeichnung Grease-Pencil-Striche machen, die durch Kreuzungen "
        "hindurchlaufen"
    ),
    "File": "Datei",
    "Picture to trace; empty for the image given below or the active image Empty": (
        "Bild, das nachgezogen wird; leer für das Bild darunter oder das aktive Bild-Empty"
    ),
    "Image": "Bild",
    "Name of the image data-block to trace": "Name des Bild-Datenblocks, der nachgezogen wird",
    "Target": "Ziel",
    "Where the strokes go": "Wohin die Striche kommen",
    "New Object": "Neues Objekt",
    "A Grease Pencil object per drawing": "Ein Grease-Pencil-Objekt je Zeichnung",
    "Active Object": "Aktives Objekt",
    "A keyframe of the active Grease Pencil object": (
        "Ein Keyframe des aktiven Grease-Pencil-Objekts"
    ),
    "Trace scanned drawings from files as Grease Pencil strokes": (
        "Gescannte Zeichnungen aus Dateien als Grease-Pencil-Striche nachziehen"
    ),
    "Trace Scanned Drawings": "Gescannte Zeichnungen nachziehen",
    "Trace {name}": "{name} nachziehen",
    "Trace What {name} Plays": "Nachziehen, was {name} abspielt",
    "Trace Files...": "Dateien nachziehen...",
    "Trace Sequence...": "Bildfolge nachziehen...",
    "Trace as Grease Pencil": "Als Grease Pencil nachziehen",
    "Scanned Drawing as Grease Pencil (Involute)": (
        "Gescannte Zeichnung als Grease Pencil (Involute)"
    ),
    "Drawing Sequence as Grease Pencil (Involute)": "Bildfolge als Grease Pencil (Involute)",
    "Scanned Drawing...": "Gescannte Zeichnung...",
    "Drawing Sequence...": "Bildfolge...",
    "Trace as Keyframes (Involute)": "Als Keyframes nachziehen (Involute)",
    "Trace as Strokes (Involute)": "Als Striche nachziehen (Involute)",
    "Cancel": "Abbrechen",
    "Stop the trace that is running; nothing in the scene changes": (
        "Das laufende Nachziehen anhalten; in der Szene ändert sich nichts"
    ),
    "{stage}, {percent} % (Esc cancels)": "{stage}, {percent} % (Esc bricht ab)",
    "Reading the picture": "Bild wird gelesen",
    "Looking for solid blacks": "Schwarze Flächen werden gesucht",
    "Finding the lines": "Linien werden gesucht",
    "Finding the junctions": "Kreuzungen werden gesucht",
    "Routing the junctions": "Kreuzungen werden verbunden",
    "Drawing the strokes": "Striche werden gezeichnet",
    "Comparing with the ink": "Vergleich mit der Tinte",
    "{done} of {count} frames": "{done} von {count} Bildern",
    "Result": "Ergebnis",
    "{strokes:,} strokes, {solids:,} solids, {seconds:.1f} s": (
        "{strokes:,} Striche, {solids:,} Flächen, {seconds:.1f} s"
    ),
    "{junctions:,} junctions, {bundles:,} bundles, {doubtful:,} doubtful": (
        "{junctions:,} Kreuzungen, {bundles:,} Bündel, {doubtful:,} zweifelhaft"
    ),
    (
        "{strokes} strokes, {junctions} junctions and {bundles} bundles "
        "({doubtful} doubtful), {seconds:.1f} s"
    ): (
        "{strokes} Striche, {junctions} Kreuzungen und {bundles} Bündel "
        "({doubtful} zweifelhaft), {seconds:.1f} s"
    ),
    "{junctions:,} junctions, {doubtful:,} doubtful": (
        "{junctions:,} Kreuzungen, {doubtful:,} zweifelhaft"
    ),
    "{strokes} strokes, {junctions} junctions ({doubtful} doubtful), {seconds:.1f} s": (
        "{strokes} Striche, {junctions} Kreuzungen ({doubtful} zweifelhaft), {seconds:.1f} s"
    ),
    "Another trace is running; wait for it or cancel it.": (
        "Es wird schon nachgezogen; warte darauf oder brich es ab."
    ),
    "Tracing was cancelled.": "Das Nachziehen wurde abgebrochen.",
    "There is nothing to trace.": "Es gibt nichts nachzuziehen.",
    "There are no lines in the picture.": "In dem Bild sind keine Linien.",
    "There is no image {name!r} in this file.": "In dieser Datei gibt es kein Bild {name!r}.",
    "The image {name!r} has no pixels; reload it or choose another.": (
        "Das Bild {name!r} hat keine Pixel; lade es neu oder wähle ein anderes."
    ),
    "Choose a picture file, or select an Empty that shows an image.": (
        "Wähle eine Bilddatei oder ein Empty, das ein Bild zeigt."
    ),
    "Make a Grease Pencil object of this file the active one.": (
        "Mache ein Grease-Pencil-Objekt dieser Datei zum aktiven."
    ),
    "There is not enough memory for a picture of this size.": (
        "Für ein Bild dieser Größe reicht der Speicher nicht."
    ),
    # settings
    "What the Drawing Is": "Was die Zeichnung ist",
    "How Clean": "Wie sauber",
    "How Many Points": "Wie viele Punkte",
    "Drawing": "Zeichnung",
    "Whether every line is drawn once or by many pencil strokes": (
        "Ob jede Linie einmal gezeichnet ist oder mit vielen Bleistiftstrichen"
    ),
    "Rough where many lines run beside themselves": (
        "Roh, wo viele Linien neben sich selbst laufen"
    ),
    "Clean": "Rein",
    "Every line is drawn once": "Jede Linie ist einmal gezeichnet",
    "Rough": "Roh",
    "Many pencil strokes say one line: find that line": (
        "Viele Bleistiftstriche meinen eine Linie: diese Linie finden"
    ),
    "Lines": "Linien",
    "Which side of the picture is ink": "Welche Seite des Bildes Tusche ist",
    "Find out from the picture": "Am Bild herausfinden",
    "Dark on Light": "Dunkel auf Hell",
    "Ink or pencil on paper": "Tusche oder Bleistift auf Papier",
    "Light on Dark": "Hell auf Dunkel",
    "Chalk, blueprints, inverted scans": "Kreide, Blaupausen, umgekehrte Scans",
    "Pen Width": "Strichstärke",
    "Usual width of a line in pixels of the picture; 0 measures it": (
        "Übliche Breite einer Linie in Pixeln des Bildes; 0 misst sie"
    ),
    "Line Finder": "Liniensuche",
    "What finds the centres of the lines": "Was die Mitten der Linien findet",
    "The trained network when it is there, else the ridge filter": (
        "Das gelernte Netz, wenn es da ist, sonst der Gratfilter"
    ),
    "Network": "Netz",
    "Trained on pencil, ink, chalk and bad scans": (
        "An Bleistift, Tusche, Kreide und schlechten Scans gelernt"
    ),
    "Grain": "Korn",
    "From how far the page is looked at, so that grainy lines are whole": (
        "Aus welcher Entfernung die Seite betrachtet wird, damit körnige Linien ganz bleiben"
    ),
    "Closely, and where soft lines are torn from afar as well; the simpler drawing is kept": (
        "Aus der Nähe, und wo weiche Linien zerrissen sind, auch von weitem; die einfachere bleibt"
    ),
    "As close as the pen is wide: ink, markers, clean pencil": (
        "So nah, wie der Stift breit ist: Tinte, Filzstift, sauberer Bleistift"
    ),
    "At 0.7 of that size: soft pencil, crayon": (
        "Bei 0,7 dieser Größe: weicher Bleistift, Kreidestift"
    ),
    "At 0.55 of that size: charcoal, chalk, rough paper": (
        "Bei 0,55 dieser Größe: Kohle, Kreide, raues Papier"
    ),
    "Fine": "Fein",
    "Medium": "Mittel",
    "Coarse": "Grob",
    "The lines are grainy: traced from farther away (--grain {0}).": (
        "Die Linien sind körnig: aus größerer Entfernung nachgezeichnet (--grain {0})."
    ),
    "Coarsest": "Gröbstes",
    "At 0.4 of that size: what falls to shreds even so": (
        "Bei 0,4 dieser Größe: was auch so noch in Fetzen kommt"
    ),
    "Lean Network": "Schlankes Netz",
    "Smaller, in three quarters of the time; cuts grainy lines more": (
        "Ein kleineres in drei Vierteln der Zeit; zerlegt körnige Linien öfter"
    ),
    "Ridge Filter": "Gratfilter",
    "No learning; for very clean lines": "Ohne Lernen; für sehr saubere Linien",
    "Picture Is Centerlines": "Das Bild zeigt Mittellinien",
    "Thin white lines on black, made elsewhere": (
        "Dünne weiße Linien auf Schwarz, anderswo gemacht"
    ),
    "Solid Blacks": "Schwarze Flächen",
    "Turn areas of solid ink into fills instead of tracing them as lines": (
        "Flächen voller Tusche zu Füllungen machen, statt sie als Linien nachzuziehen"
    ),
    "Ink Colors": "Tuschefarben",
    "Give every ink its own layer and material; off draws all lines in black": (
        "Jeder Tusche eine eigene Ebene und ein eigenes Material geben; sonst werden alle Linien "
        "schwarz"
    ),
    "Ignore Inks": "Tuschen weglassen",
    "Inks that are not traced, such as a blue construction pencil": (
        "Tuschen, die nicht nachgezogen werden, etwa ein blauer Vorzeichenstift"
    ),
    "None": "Keine",
    "Don't trace lines of this color": "Linien dieser Farbe nicht nachziehen",
    "Red": "Rot",
    "Orange": "Orange",
    "Yellow": "Gelb",
    "Green": "Grün",
    "Cyan": "Cyan",
    "Blue": "Blau",
    "Purple": "Violett",
    "Pink": "Rosa",
    "Gray": "Grau",
    "Solid Width": "Flächenbreite",
    "Leave Out Rules": "Lineatur weglassen",
    "Don't trace the printed lines of ruled and squared paper": (
        "Die gedruckten Linien von liniertem und kariertem Papier nicht nachziehen"
    ),
    "Leave Out Screentone": "Rasterfolie weglassen",
    "Don't trace areas of evenly set dots, such as the tones of a comic": (
        "Flächen aus gleichmäßig gesetzten Punkten nicht nachziehen, etwa die Töne eines Comics"
    ),
    "Leave Out Surroundings": "Umgebung weglassen",
    "Don't trace what lies beyond the sheet in a photograph: cloth, a desk, a finger": (
        "Was auf einem Foto neben dem Blatt liegt, nicht nachziehen: Stoff, Tisch, ein Finger"
    ),
    "Straighten Sheet": "Blatt entzerren",
    "Take the perspective out of a photographed sheet, as seen from straight above": (
        "Ein fotografiertes Blatt entzerren, als sähe man gerade von oben darauf"
    ),
    "Leave Out the Back": "Rückseite weglassen",
    "Don't trace what shows through from the back of the sheet, paler and softer": (
        "Nicht nachziehen, was von der Rückseite des Blattes durchscheint, blasser und weicher"
    ),
    "Lines wider than this, in pixels of the picture, are solid areas; 0 finds out from the pen": (
        "Linien, die breiter sind (in Bildpunkten), sind Flächen; 0 ermittelt es aus der Feder"
    ),
    "Keep Dots": "Punkte behalten",
    "Keep dots of full ink about as wide as the pen, which are no specks": (
        "Satte Punkte behalten, die etwa so breit wie die Feder und damit keine Flecken sind"
    ),
    "Join Dashes": "Gestricheltes verbinden",
    "Make one stroke of a dashed or dotted line, and note how it is dashed": (
        "Aus einer gestrichelten oder punktierten Linie einen Strich machen und festhalten, wie "
        "sie gestrichelt ist"
    ),
    "Opacity": "Deckkraft",
    "How opaque the strokes are": "Wie stark die Striche decken",
    "Solid": "Deckend",
    "Solid for ink, as drawn for pencil": "Deckend bei Tinte, wie gezeichnet bei Bleistift",
    "Every stroke is opaque": "Jeder Strich deckt",
    "As Drawn": "Wie gezeichnet",
    "As strong as the line on the paper": "So kräftig wie die Linie auf dem Papier",
    "Width Scale": "Breitenfaktor",
    "Make the strokes this many times as wide as the lines on the paper": (
        "Die Striche so viel mal so breit machen wie die Linien auf dem Papier"
    ),
    "Even Width": "Gleichmäßige Breite",
    "Give each stroke one width all along, that of its line on average": (
        "Jedem Strich eine einzige Breite geben, die mittlere seiner Linie"
    ),
    "Leave Out Marks": "Marken weglassen",
    "Don't trace scan borders, punched holes and registration marks": (
        "Scanränder, Lochungen und Passmarken nicht nachziehen"
    ),
    "Fill Regions": "Gebiete füllen",
    "Fill the closed regions between the lines, on a layer below": (
        "Die geschlossenen Gebiete zwischen den Linien füllen, auf einer Ebene darunter"
    ),
    "Specks": "Flecken",
    "Drop lone strokes shorter than this many pen widths": (
        "Einzelne Striche weglassen, die kürzer sind als so viele Strichstärken"
    ),
    "Smoothing": "Glättung",
    "0 keeps every wobble of the hand, 1 is very smooth": (
        "0 behält jedes Zittern der Hand, 1 ist sehr glatt"
    ),
    "Pen Lifts": "Absetzen",
    "Where strokes end though only two lines meet: -1 nowhere, 0 where it looks as if the pen was "
    "lifted, 1 wherever it may have been": (
        "Wo Striche enden, obwohl sich nur zwei Linien treffen: -1 nirgends, 0 wo es aussieht, als "
        "sei der Stift abgesetzt worden, 1 überall, wo es sein kann"
    ),
    "Junctions": "Kreuzungen",
    "What decides which lines continue through a junction": (
        "Was entscheidet, welche Linien durch eine Kreuzung weiterlaufen"
    ),
    "The trained network when it is there, else geometry": (
        "Das gelernte Netz, wenn es da ist, sonst die Geometrie"
    ),
    "Looks at the whole neighborhood of the junction": (
        "Betrachtet die ganze Umgebung der Kreuzung"
    ),
    "Geometry": "Geometrie",
    "Looks at direction, curvature and width only": (
        "Betrachtet nur Richtung, Krümmung und Breite"
    ),
    "Tolerance": "Toleranz",
    "How far a stroke may stray from the traced line, in pixels of the picture; more gives fewer "
    "points": (
        "Wie weit ein Strich von der nachgezogenen Linie abweichen darf, in Pixeln des Bildes; "
        "mehr gibt weniger Punkte"
    ),
    "Curves": "Kurven",
    "What the strokes are made of": "Woraus die Striche bestehen",
    "Points": "Punkte",
    "Plain points, for sculpting and drawing over": (
        "Einfache Punkte, zum Modellieren und Überzeichnen"
    ),
    "Bézier": "Bézier",
    "Few points with handles": "Wenige Punkte mit Griffen",
    "Device": "Gerät",
    "Where the networks run": "Wo die Netze laufen",
    "A graphics card when one can be used, else the processor": (
        "Eine Grafikkarte, wenn eine zu gebrauchen ist, sonst der Prozessor"
    ),
    "Processor": "Prozessor",
    "Always works": "Geht immer",
    "Graphics Card": "Grafikkarte",
    "Needs PyTorch in Blender's Python": "Braucht PyTorch in Blenders Python",
    "Reset to Defaults": "Auf Voreinstellungen zurücksetzen",
    "Set all trace settings back to the defaults that are in the preferences": (
        "Alle Einstellungen auf die Vorgaben in den Voreinstellungen zurücksetzen"
    ),
    "Trace Preset": "Vorlage zum Nachziehen",
    "Trace Presets": "Vorlagen zum Nachziehen",
    "Add or remove a preset of the trace settings": (
        "Eine Vorlage der Einstellungen hinzufügen oder entfernen"
    ),
    # where a drawing stands
    "Place": "Ort",
    "Where a new drawing stands; on an image Empty it always lies on the image": (
        "Wo eine neue Zeichnung steht; an einem Bild-Empty liegt sie immer auf dem Bild"
    ),
    "Front View": "Vorderansicht",
    "Automatic": "Automatisch",
    "Fit to the camera while you look through it, else front view": (
        "In die Kamera einpassen, solange man durch sie blickt, sonst Vorderansicht"
    ),
    "Upright at the world's origin, before what stands there": (
        "Aufrecht am Ursprung der Welt, vor dem, was dort steht"
    ),
    "Scan Behind": "Scan dahinter",
    "Where It Goes": "Wohin es kommt",
    "Scan": "Scan",
    "Fit to Camera": "In die Kamera einpassen",
    "Fill the view of the scene's camera, facing it": (
        "Den Blick der Szenenkamera füllen, ihr zugewandt"
    ),
    "Drawing Plane": "Zeichenebene",
    "As the scene's Stroke Placement and Drawing Plane say": (
        "Wie Strichplatzierung und Zeichenebene der Szene sagen"
    ),
    "Pixels per Metre": "Pixel je Meter",
    "Size of a new drawing; 0 makes it 2 metres tall. Fit to Camera ignores it": (
        "Größe einer neuen Zeichnung; 0 macht sie 2 Meter hoch. In die Kamera einpassen beachtet "
        "sie nicht"
    ),
    "There is no camera in the scene to fit to; add one, or place it else.": (
        "In der Szene ist keine Kamera zum Einpassen; füge eine hinzu oder wähle einen anderen Ort."
    ),
    # sequences
    "Trace Sequence": "Bildfolge nachziehen",
    "Turn numbered drawings into keyframes of one Grease Pencil object, in the background": (
        "Aus nummerierten Zeichnungen Keyframes eines Grease-Pencil-Objekts machen, im Hintergrund"
    ),
    "Trace Drawing Sequence": "Bildfolge nachziehen",
    "Choose a folder of numbered drawings, or some of them, and trace them as keyframes": (
        "Einen Ordner nummerierter Zeichnungen oder einige davon wählen und als Keyframes "
        "nachziehen"
    ),
    "Start At": "Beginnen bei",
    "Put the first drawing at a frame of your choice instead of its own number": (
        "Die erste Zeichnung auf ein Bild deiner Wahl setzen statt auf ihre eigene Nummer"
    ),
    "Start Frame": "Erstes Bild",
    "Frame of the first drawing": "Bild der ersten Zeichnung",
    "Step": "Schritt",
    "Frames from one number to the next; 2 animates on twos": (
        "Bilder von einer Nummer zur nächsten; 2 animiert auf Zweiern"
    ),
    "Align by Peg Holes": "An den Lochungen ausrichten",
    "Bring all pages to where the peg holes or registration marks of the first lie": (
        "Alle Seiten dorthin bringen, wo die Lochungen oder Passmarken der ersten liegen"
    ),
    "Steady Strokes": "Stetige Striche",
    "Give neighboring frames the same order and direction of strokes, so that Interpolate pairs "
    "them rightly": (
        "Benachbarten Bildern dieselbe Reihenfolge und Richtung der Striche geben, damit "
        "Interpolieren die richtigen paart"
    ),
    "Processes": "Prozesse",
    "Drawings traced at the same time; 0 uses every processor core": (
        "Zeichnungen, die gleichzeitig nachgezogen werden; 0 nutzt jeden Prozessorkern"
    ),
    "Folder": "Ordner",
    "Folder of numbered drawings; empty for what the active image Empty plays": (
        "Ordner nummerierter Zeichnungen; leer für das, was das aktive Bild-Empty abspielt"
    ),
    "Only What Changed": "Nur Geändertes",
    "Fill the active object; keyframes whose drawing has not changed stay as they are, with all "
    "that was done to them": (
        "Das aktive Objekt füllen; Keyframes, deren Zeichnung sich nicht geändert hat, bleiben mit "
        "allem, was an ihnen getan wurde"
    ),
    "Choose a folder of drawings, or select an Empty that plays images or a movie.": (
        "Wähle einen Ordner mit Zeichnungen oder ein Empty, das Bilder oder einen Film abspielt."
    ),
    "Make the Grease Pencil object of the sequence the active one.": (
        "Mache das Grease-Pencil-Objekt der Bildfolge zum aktiven."
    ),
    "None of the frames could be traced.": "Keines der Bilder konnte nachgezogen werden.",
    "Frame {frame}": "Bild {frame}",
    "{count} keyframes": "{count} Keyframes",
    "{count} kept": "{count} behalten",
    "{count} frames failed": "{count} Bilder misslungen",
    "then cancelled": "dann abgebrochen",
    "There is no folder {path}; check the path.": ("Es gibt keinen Ordner {path}; prüfe den Pfad."),
    "There is no picture in {path}; choose another folder.": (
        "In {path} ist kein Bild; wähle einen anderen Ordner."
    ),
    "{name} plays no frame; set its Frames to more than 0.": (
        "{name} spielt kein Bild ab; setze seine Bilder auf mehr als 0."
    ),
    "There is no folder {path}; find the images again.": (
        "Es gibt keinen Ordner {path}; suche die Bilder neu."
    ),
    "There is no file {path}; find the images again.": (
        "Es gibt keine Datei {path}; suche die Bilder neu."
    ),
    # the list of junctions
    "Sort": "Sortieren",
    "Order of the list": "Reihenfolge der Liste",
    "Doubt": "Zweifel",
    "The most doubtful first": "Die zweifelhaftesten zuerst",
    "From the top of the page to the bottom": "Vom oberen Rand der Seite zum unteren",
    "Doubtful": "Zweifelhaft",
    "List doubtful junctions only": "Nur zweifelhafte Kreuzungen zeigen",
    "Unlocked": "Offen",
    "Leave out junctions that you have fixed": "Kreuzungen weglassen, die du festgelegt hast",
    "How many lines meet": "Wie viele Linien sich treffen",
    "Any": "Alle",
    "Any number of lines": "Beliebig viele Linien",
    "Three lines meet": "Drei Linien treffen sich",
    "Four lines meet": "Vier Linien treffen sich",
    "Five or more lines meet": "Fünf oder mehr Linien treffen sich",
    "Page": "Seite",
    "Page of the list": "Seite der Liste",
    "Page of {count}": "Seite von {count}",
    "{some} of {all}": "{some} von {all}",
    "{count} lines": "{count} Linien",
    "Bundle": "Bündel",
    "One line": "Eine Linie",
    "Two lines": "Zwei Linien",
    "Pencil strokes beside each other: one line or two": (
        "Bleistiftstriche nebeneinander: eine Linie oder zwei"
    ),
    "No junction passes the filters": "Keine Kreuzung passt zu den Filtern",
    "No junction passes the filters.": "Keine Kreuzung passt zu den Filtern.",
    "Previous": "Vorige",
    "Next": "Nächste",
    "Direction": "Richtung",
    "Which way along the list": "In welcher Richtung durch die Liste",
    "The next junction of the list": "Die nächste Kreuzung der Liste",
    "The junction before in the list": "Die Kreuzung davor in der Liste",
    "Next or Previous Junction": "Nächste oder vorige Kreuzung",
    "Go to the next or previous junction of the list": (
        "Zur nächsten oder vorigen Kreuzung der Liste gehen"
    ),
    "Go to Junction": "Zur Kreuzung gehen",
    "Look at this junction": "Diese Kreuzung ansehen",
    "Move View": "Ansicht bewegen",
    "Bring the junction to the middle of the view": (
        "Die Kreuzung in die Mitte der Ansicht bringen"
    ),
    "Above": "Über",
    "Accept {count}": "{count} annehmen",
    "Stroke Colors": "Strichfarben",
    "Strokes": "Striche",
    "Show every stroke in a color of its own, with its ends marked": (
        "Jeden Strich in eigener Farbe zeigen, die Enden markiert"
    ),
    "Stroke Width": "Strichbreite",
    "Width of a stroke that is shown in a color of its own, in pixels": (
        "Breite eines Strichs, der in eigener Farbe gezeigt wird, in Pixeln"
    ),
    "One of the colors that tell strokes apart": (
        "Eine der Farben, die Striche voneinander unterscheiden"
    ),
    "Stroke Color 1": "Strichfarbe 1",
    "Stroke Color 2": "Strichfarbe 2",
    "Stroke Color 3": "Strichfarbe 3",
    "Stroke Color 4": "Strichfarbe 4",
    "Stroke Color 5": "Strichfarbe 5",
    "Stroke Color 6": "Strichfarbe 6",
    "Accept Certain Junctions": "Sichere Kreuzungen annehmen",
    "Lock every junction that is at least this certain": (
        "Jede Kreuzung sperren, die mindestens so sicher ist"
    ),
    "Certainty": "Sicherheit",
    "Least probability of the routing in force": (
        "Kleinste Wahrscheinlichkeit der geltenden Verbindung"
    ),
    "{count} junctions accepted": "{count} Kreuzungen angenommen",
    "Ask Again": "Neu fragen",
    "Route all junctions that are not locked again, given what you have fixed": (
        "Alle Kreuzungen, die nicht gesperrt sind, neu verbinden, ausgehend von dem, was du "
        "festgelegt hast"
    ),
    "{count} junctions changed": "{count} Kreuzungen geändert",
    # one junction
    "Current Junction": "Aktuelle Kreuzung",
    "Junction": "Kreuzung",
    "Number of the junction": "Nummer der Kreuzung",
    "Number of the junction; -1 is the current one": "Nummer der Kreuzung; -1 ist die aktuelle",
    "Alternative": "Möglichkeit",
    "Which alternative": "Welche Möglichkeit",
    "Which alternative, the most probable is 0": (
        "Welche Möglichkeit; die wahrscheinlichste ist 0"
    ),
    "{lines} ends": "{lines} endet",
    "{lines} end": "{lines} enden",
    "Lock Junction": "Kreuzung sperren",
    "Lock the junction: it counts as certain, and Ask Again learns from it; or unlock it": (
        "Die Kreuzung sperren: sie gilt als sicher, und Neu fragen lernt daraus; oder sie freigeben"
    ),
    "Lock or Unlock": "Sperren oder freigeben",
    "Preview Alternative": "Möglichkeit zeigen",
    "Show this alternative in the viewport without applying it; again to stop": (
        "Diese Möglichkeit in der Ansicht zeigen, ohne sie anzuwenden; noch einmal, um aufzuhören"
    ),
    "Reroute Junction": "Kreuzung neu verbinden",
    "Let the lines continue through the junction in this way; only they change": (
        "Die Linien so durch die Kreuzung laufen lassen; nur sie ändern sich"
    ),
    "Choose in Viewport": "In der Ansicht wählen",
    "Choose Routing": "Verbindung wählen",
    "Show the alternatives of a junction as cards: point to preview, click to apply": (
        "Die Möglichkeiten einer Kreuzung als Karten zeigen: zeigen, um sie zu sehen, klicken, um "
        "sie anzuwenden"
    ),
    "Point at a card to preview, click or Enter to apply, wheel or arrows for the next, L locks, "
    "Esc leaves": (
        "Auf eine Karte zeigen, um sie zu sehen, Klick oder Eingabe wendet sie an, Rad oder Pfeile "
        "für die nächste, L sperrt, Esc verlässt"
    ),
    "Pick": "Greifen",
    "Take the junction under the mouse instead of the current one": (
        "Die Kreuzung unter der Maus statt der aktuellen nehmen"
    ),
    "By Hand": "Von Hand",
    "Join Lines": "Linien verbinden",
    "Let one of these lines continue in the other; what they continued in before ends here": (
        "Eine dieser Linien in der anderen weiterlaufen lassen; worin sie vorher weiterliefen, "
        "endet hier"
    ),
    "First": "Erste",
    "Second": "Zweite",
    "Number of a half-branch": "Nummer eines Halbzweigs",
    "Number of the other half-branch": "Nummer des anderen Halbzweigs",
    "Ends": "Endet",
    "Separate Lines": "Linien trennen",
    "Separate All Lines": "Alle Linien trennen",
    "End a line at its junction, or all lines of the current junction": (
        "Eine Linie an ihrer Kreuzung enden lassen, oder alle Linien der aktuellen Kreuzung"
    ),
    "Line": "Linie",
    "Number of the half-branch; -1 separates all": "Nummer des Halbzweigs; -1 trennt alle",
    "Drag to Join": "Ziehen zum Verbinden",
    "Choose a junction first.": "Wähle zuerst eine Kreuzung.",
    "This junction has {count} alternatives.": "Diese Kreuzung hat {count} Möglichkeiten.",
    "Select a drawing that Involute has traced": (
        "Wähle eine Zeichnung, die Involute nachgezogen hat"
    ),
    "This drawing is linked from another file; make it local to change it.": (
        "Diese Zeichnung ist aus einer anderen Datei verknüpft; mache sie lokal, um sie zu ändern."
    ),
    "This drawing was not traced by Involute.": (
        "Diese Zeichnung wurde nicht von Involute nachgezogen."
    ),
    "A newer Involute traced this drawing; update the extension.": (
        "Ein neueres Involute hat diese Zeichnung nachgezogen; aktualisiere die Erweiterung."
    ),
    "A stroke at this junction was changed so much that its ends can't be told; nothing was "
    "changed.": (
        "Ein Strich an dieser Kreuzung wurde so verändert, dass seine Enden nicht zu erkennen "
        "sind; nichts wurde geändert."
    ),
    # what is looked at
    "The traced drawing that is looked at": "Die Zeichnung, die betrachtet wird",
    "The current junction": "Die aktuelle Kreuzung",
    "Preview": "Vorschau",
    "The alternative that is shown but not applied": (
        "Die Möglichkeit, die gezeigt, aber nicht angewandt wird"
    ),
    "Choosing": "Wählen",
    "The cards of the alternatives are shown": "Die Karten der Möglichkeiten werden gezeigt",
    "Junction Overlay": "Kreuzungen einblenden",
    "Show junctions in the viewport, colored by doubt": (
        "Kreuzungen in der Ansicht zeigen, nach Zweifel gefärbt"
    ),
    # preferences
    "Defaults": "Vorgaben",
    "Trace settings that Reset to Defaults brings back": (
        "Einstellungen, die Auf Voreinstellungen zurücksetzen zurückbringt"
    ),
    "Certain": "Sicher",
    "Color of junctions that are certain": "Farbe sicherer Kreuzungen",
    "Color of the most doubtful junctions": "Farbe der zweifelhaftesten Kreuzungen",
    "Locked": "Gesperrt",
    "Color of junctions that you have fixed": "Farbe von Kreuzungen, die du festgelegt hast",
    "Ring Size": "Ringgröße",
    "Radius of a certain junction's ring, in pen widths": (
        "Radius des Rings einer sicheren Kreuzung, in Strichstärken"
    ),
    "Default Trace Settings": "Vorgaben zum Nachziehen",
    "Keys in the 3D Viewport": "Tasten in der 3D-Ansicht",
    "Networks": "Netze",
    "Line finder": "Liniensuche",
    "Lean line finder": "Schlanke Liniensuche",
    "Junction router": "Verbinden der Kreuzungen",
    "not installed: the method without learning is used": (
        "nicht installiert: das Verfahren ohne Lernen wird benutzt"
    ),
    "Choose one picture file or several.": "Eine oder mehrere Bilddateien auswählen.",
    "Review Junctions": "Kreuzungen durchgehen",
    "Decide the doubtful junctions one after the other, those first where most depends on it": (
        "Die zweifelhaften Kreuzungen nacheinander entscheiden; zuerst die, an denen am meisten "
        "hängt"
    ),
    "No junction is doubtful any more.": "Keine Kreuzung ist mehr zweifelhaft.",
    "A review needs a 3D viewport.": "Das Durchgehen braucht einen 3D-Viewport.",
    "Cost": "Kosten",
    "Doubt times the length of stroke that another answer changes": (
        "Zweifel mal Länge der Striche, die eine andere Antwort ändert"
    ),
    # presets
    "Use Preset": "Vorgabe verwenden",
    "Set all trace settings to what suits a kind of drawing": (
        "Alle Einstellungen so wählen, wie sie zu einer Art von Zeichnung passen"
    ),
    "Preset": "Vorgabe",
    "What kind of drawing it is": "Was für eine Zeichnung es ist",
    "Ink": "Tusche",
    "Pen drawings on paper; the defaults": (
        "Federzeichnungen auf Papier; die Standardeinstellungen"
    ),
    "Pencil": "Bleistift",
    "Soft lines of changing darkness, crumbs left out; no solid blacks": (
        "Weiche Linien wechselnder Schwärze, Krümel weggelassen; keine Schwarzflächen"
    ),
    "Brush and Marker": "Pinsel und Marker",
    "Broad, swelling lines in few points, thick places not taken for solids": (
        "Breite, schwellende Linien mit wenigen Punkten; dicke Stellen gelten nicht als Flächen"
    ),
    "Blueprint": "Blaupause",
    "Light lines on dark paper, all in one ink, corners kept sharp": (
        "Helle Linien auf dunklem Papier, alle in einer Farbe, mit scharfen Ecken"
    ),
    "Binarised Animation Lines": "Binarisierte Animationslinien",
    "Hard black and colored lines without grey, closed regions filled": (
        "Harte schwarze und farbige Linien ohne Grau, geschlossene Gebiete gefüllt"
    ),
    "Comic Page": "Comicseite",
    "Ink with solid blacks, all in one ink, specks of the print left out": (
        "Tusche mit Schwarzflächen, alles in einer Farbe, Druckpunkte weggelassen"
    ),
    "Next Junction": "Nächste Kreuzung",
    "Previous Junction": "Vorherige Kreuzung",
    # what can't be done
    "This drawing has no junctions any more: what was stored of them is damaged. "
    "Its strokes stay as they are.": (
        "Diese Zeichnung hat keine Kreuzungen mehr: was von ihnen gespeichert war, ist beschädigt. "
        "Ihre Striche bleiben, wie sie sind."
    ),
    "The strokes at this junction were deleted, or joined by hand; nothing was changed.": (
        "Die Striche an dieser Kreuzung wurden gelöscht oder von Hand verbunden; nichts wurde "
        "geändert."
    ),
    "The layer {name!r} is locked; unlock it to reroute.": (
        "Die Ebene {name!r} ist gesperrt; zum Neuverbinden entsperren."
    ),
    # gestures
    "Cut Strokes": "Striche zerschneiden",
    "Cut the strokes that a path crosses there; the cuts are decisions of yours and stay": (
        "Die Striche zerschneiden, wo ein Weg sie kreuzt; die Schnitte sind deine Entscheidungen "
        "und bleiben"
    ),
    "Decide all corners that you have not decided yourself anew": (
        "Alle Ecken, die du nicht selbst entschieden hast, neu entscheiden"
    ),
    "Drag along a line to let one stroke follow it, from line to line or end to end to join": (
        "An einer Linie entlang ziehen, damit ein Strich ihr folgt, von Linie zu Linie oder von "
        "Ende zu Ende, um zu verbinden"
    ),
    "Drag along a line, from one line to another that meets it at a junction, or from one end to "
    "another.": (
        "Ziehe an einer Linie entlang, von einer Linie zu einer anderen, die sie an einer "
        "Kreuzung trifft, oder von einem Ende zu einem anderen."
    ),
    "Draw along a line, over at least one junction.": (
        "Zeichne an einer Linie entlang, über mindestens eine Kreuzung."
    ),
    "How far lines may lie from the path, in pixels of the scan": (
        "Wie weit Linien vom Weg entfernt sein dürfen, in Pixeln des Scans"
    ),
    "Let one stroke follow a path; what else meets on its way is decided anew around it": (
        "Einen Strich einem Weg folgen lassen; was sonst am Weg zusammentrifft, wird darum herum "
        "neu entschieden"
    ),
    "Nobody looked for corners; trace again with Pen Lifts above -1.": (
        "Ecken wurden nicht gesucht; ziehe noch einmal nach, mit „Absetzen“ über -1."
    ),
    "Only two lines that meet at one junction, or two ends, can be joined.": (
        "Nur zwei Linien, die sich an einer Kreuzung treffen, oder zwei Enden lassen sich "
        "verbinden."
    ),
    "Path": "Weg",
    "Radius": "Umkreis",
    "Route Along Path": "An einem Weg entlang führen",
    "Set Pen Lifts": "Absetzen einstellen",
    "Swipe to Cut": "Mit einem Wisch zerschneiden",
    "The swipe crosses no stroke.": "Der Wisch kreuzt keinen Strich.",
    "Where the cut runs, in pixels of the scan": "Wo der Schnitt verläuft, in Pixeln des Scans",
    "Where the stroke is to run, in pixels of the scan": (
        "Wo der Strich verlaufen soll, in Pixeln des Scans"
    ),
    "{count} strokes": "{count} Striche",
    "Swipe across strokes to cut them there; a click on a line ends it at its junction": (
        "Quer über Striche wischen, um sie dort zu zerschneiden; ein Klick auf eine Linie lässt "
        "sie an ihrer Kreuzung enden"
    ),
    "Click a junction to choose among its alternatives\n"
    "Drag along a line to let one stroke follow it; from line to line or end to end to "
    "join\n"
    "Ctrl-drag or Alt-drag across strokes to cut them\n"
    "Ctrl-click or Alt-click a line to end it at its junction\n"
    "Shift-drag around junctions to accept them; with Ctrl, too, a box": (
        "Eine Kreuzung anklicken, um unter ihren Möglichkeiten zu wählen\n"
        "An einer Linie entlang ziehen, damit ein Strich ihr folgt; von Linie zu Linie oder von "
        "Ende zu Ende, um zu verbinden\n"
        "Mit Strg oder Alt quer über Striche ziehen, um sie zu zerschneiden\n"
        "Eine Linie mit Strg oder Alt anklicken, um sie an ihrer Kreuzung enden zu lassen\n"
        "Mit Umschalt um Kreuzungen herum ziehen, um sie anzunehmen; mit Strg dazu einen Kasten"
    ),
    "Accept Inside": "Innerhalb annehmen",
    "Box": "Kasten",
    "Draw a box instead": "Stattdessen einen Kasten ziehen",
    "Draw around junctions to accept them as they are": (
        "Kreuzungen umfahren, um sie anzunehmen, wie sie sind"
    ),
    "Lasso to Accept": "Lasso zum Annehmen",
    "Lock every junction inside an outline as it is": (
        "Jede Kreuzung innerhalb eines Umrisses sperren, wie sie ist"
    ),
    "No open junction lies inside.": "Darin liegt keine offene Kreuzung.",
    "The outline, in pixels of the scan": "Der Umriss, in Pixeln des Scans",
    "{number} of {all}, {long} long strokes left, {settled} settled by your decisions: digit or "
    "click decides, Enter accepts, S decides all that are alike, Space skips, Backspace goes "
    "back, Esc leaves": (
        "{number} von {all}, {long} lange Striche übrig, {settled} durch deine Entscheidungen "
        "erledigt: Ziffer oder Klick entscheidet, Enter nimmt an, S entscheidet alle gleichen, "
        "Leertaste überspringt, Rücktaste geht zurück, Esc beendet"
    ),
    # again, and into what is there
    "Active Layer": "Aktive Ebene",
    "As Found": "Wie gefunden",
    "As by Hand": "Wie von Hand",
    "As the lines were found on the page": "Wie die Linien auf dem Blatt gefunden wurden",
    "Do nothing if the drawing has these settings already": (
        "Nichts tun, wenn die Zeichnung diese Einstellungen schon hat"
    ),
    "In which order and direction the strokes are drawn": (
        "In welcher Reihenfolge und Richtung die Striche gezeichnet werden"
    ),
    "Live": "Sofort",
    "Long outlines first, from left to right and top to bottom, one neighborhood after the other; "
    "for the Build modifier": (
        "Lange Umrisse zuerst, von links nach rechts und von oben nach unten, eine Umgebung nach "
        "der anderen; für den Modifikator „Aufbau“"
    ),
    "Nobody noted which picture this was; trace it as a new object.": (
        "Welches Bild das war, ist nicht vermerkt; ziehe es als neues Objekt nach."
    ),
    "Show the settings in the sidebar that this drawing was traced with": (
        "In der Seitenleiste die Einstellungen zeigen, mit denen diese Zeichnung nachgezogen wurde"
    ),
    "Stroke Order": "Strichfolge",
    "The Grease Pencil object has no layer; add one to trace into.": (
        "Das Grease-Pencil-Objekt hat keine Ebene; füge eine hinzu, in die nachgezogen wird."
    ),
    "The active layer of the active Grease Pencil object, with its active material; what is there "
    "stays": (
        "Die aktive Ebene des aktiven Grease-Pencil-Objekts, mit dem aktiven Material; was dort "
        "ist, bleibt"
    ),
    "The drawing was deleted meanwhile.": "Die Zeichnung wurde inzwischen gelöscht.",
    "There is no file {path}; put it back, or trace the picture as a new object.": (
        "Es gibt keine Datei {path}; lege sie zurück, oder ziehe das Bild als neues Objekt nach."
    ),
    "The layer {name!r} is locked; unlock it to trace into it.": (
        "Die Ebene {name!r} ist gesperrt; entsperre sie, um in sie nachzuziehen."
    ),
    "The layer {name!r} is locked; unlock it to trace again.": (
        "Die Ebene {name!r} ist gesperrt; entsperre sie, um noch einmal nachzuziehen."
    ),
    "Trace Again": "Noch einmal nachziehen",
    "Trace again by itself when a setting changes": (
        "Von selbst noch einmal nachziehen, wenn sich eine Einstellung ändert"
    ),
    "Trace the picture of this drawing again with other settings; decisions and changes stay": (
        "Das Bild dieser Zeichnung mit anderen Einstellungen noch einmal nachziehen; "
        "Entscheidungen und Änderungen bleiben"
    ),
    "Use Its Settings": "Ihre Einstellungen verwenden",
    "{count} decisions have no place any more": "{count} Entscheidungen haben keinen Platz mehr",
    "{count} that you changed stay": "{count} von dir geänderte bleiben",
    "Go to the next or previous keyframe that has doubtful junctions": (
        "Zum nächsten oder vorherigen Keyframe mit zweifelhaften Kreuzungen gehen"
    ),
    "Next or Previous Doubtful Keyframe": "Nächster oder vorheriger zweifelhafter Keyframe",
    "Which way along the timeline": "In welche Richtung auf der Zeitleiste",
    "The next doubtful keyframe": "Der nächste zweifelhafte Keyframe",
    "The doubtful keyframe before": "Der zweifelhafte Keyframe davor",
    "{doubts} doubts on {some} of {all} keyframes": (
        "{doubts} Zweifel auf {some} von {all} Keyframes"
    ),
    "No other keyframe has doubtful junctions.": (
        "Kein anderer Keyframe hat zweifelhafte Kreuzungen."
    ),
    # sentences of the engine
    "Traced as light lines on dark; if the ink is dark, try --polarity dark.": (
        "Als helle Linien auf dunklem Grund nachgezogen; ist die Tusche dunkel, --polarity "
        "dark versuchen."
    ),
    "{0} of the ink is not in the drawing; try --provider classical, or a smaller "
    "--min-length where dots and specks are missing.": (
        "{0} der Tusche sind nicht in der Zeichnung; --provider classical versuchen, oder "
        "ein kleineres --min-length, wo Punkte und Flecken fehlen."
    ),
    "{0} of the length of the strokes runs over bare paper; raise --min-length, or set "
    "--pen-width.": (
        "{0} der Länge der Striche läuft über leeres Papier; --min-length erhöhen oder "
        "--pen-width setzen."
    ),
    "Taken for a rough drawing: its {0} pencil strokes say {1} lines.": (
        "Für eine Rohzeichnung gehalten: ihre {0} Bleistiftstriche sagen {1} Linien."
    ),
    "No pencil strokes of these lines run beside each other.": (
        "Keine Bleistiftstriche dieser Linien laufen nebeneinander."
    ),
    "The pencil strokes of a bundle are one line or two.": (
        "Die Bleistiftstriche eines Bündels sind eine Linie oder zwei."
    ),
    "This drawing does not know what its lines were made of; trace the picture again.": (
        "Diese Zeichnung weiß nicht, woraus ihre Linien gemacht sind; "
        "ziehe das Bild noch einmal nach."
    ),
    "This stroke ends there already.": "Dieser Strich endet dort schon.",
    "To join, two different ends of strokes are needed.": (
        "Zum Verbinden braucht es zwei verschiedene Strichenden."
    ),
    "Only ends can be joined; cut the stroke that goes on there first.": (
        "Nur Enden lassen sich verbinden; den Strich, der dort weitergeht, zuerst schneiden."
    ),
    "Only ends that meet, or that hang on nothing, can be joined.": (
        "Nur Enden, die sich treffen oder an nichts hängen, lassen sich verbinden."
    ),
    "{0} filled shapes were left out.": "{0} gefüllte Formen wurden weggelassen.",
    "What lies beyond the sheet was left out: {0} of the picture.": (
        "Was außerhalb des Blattes liegt, wurde weggelassen: {0} des Bildes."
    ),
    "What shows through from the back was left out: {0} of the ink.": (
        "Was von der Rückseite durchscheint, wurde weggelassen: {0} der Tusche."
    ),
    "The sheet was not straightened: its four corners are not sure.": (
        "Das Blatt wurde nicht entzerrt: seine vier Ecken sind nicht sicher."
    ),
    "The sheet was straightened: its corners were {0}° askew.": (
        "Das Blatt wurde entzerrt: seine Ecken waren um {0}° schief."
    ),
    (
        "The picture has white areas and is not of centerlines, thin white lines on black; "
        "choose another --provider."
    ): (
        "Das Bild hat weiße Flächen und ist keines von Mittellinien, dünnen weißen Linien auf "
        "Schwarz; wähle einen anderen --provider."
    ),
    "Printed rules were left out.": "Gedruckte Hilfslinien wurden weggelassen.",
    "Left out as no part of the drawing: {0}.": "Als nicht zur Zeichnung gehörig weggelassen: {0}.",
    "dark borders of the scan": "dunkle Ränder des Scans",
    "{0} punched holes": "{0} Lochungen",
    "{0} registration marks": "{0} Passkreuze",
    "There are no peg holes or registration marks on {0}; trace it without aligning.": (
        "Auf {0} sind keine Peglöcher oder Passkreuze; ohne Ausrichten nachziehen."
    ),
    "Screentone was left out: {0} of the page.": "Rasterfolie wurde weggelassen: {0} der Seite.",
    "{0} is damaged; give a whole {1} file.": (
        "{0} ist beschädigt; eine unbeschädigte {1}-Datei geben."
    ),
    "{0} is not a picture of a kind that is read; give {1}.": (
        "{0} ist kein Bild einer Art, die gelesen wird; {1} geben."
    ),
    "{0} is {1}, which is not read; {2}.": "{0} ist {1}, das nicht gelesen wird: {2}.",
    "save it as PNG or TIFF first": "zuerst als PNG oder TIFF speichern",
    "save its pages as PNG or TIFF first, at 300 dpi (pdftoppm -r 300 -png does it)": (
        "zuerst seine Seiten als PNG oder TIFF speichern, mit 300 dpi (pdftoppm -r 300 -png "
        "tut das)"
    ),
    "save it as PNG or JPEG first; a phone can also be set to take JPEG": (
        "zuerst als PNG oder JPEG speichern; ein Telefon lässt sich auch auf JPEG stellen"
    ),
    "{0} is {1}; give an image file (or - for a pipe).": "{0} ist {1}; eine Bilddatei geben.",
    "a folder": "ein Ordner",
    "no file": "keine Datei",
    "There is no file {0}; check the path.": "Es gibt keine Datei {0}; den Pfad prüfen.",
    "Can't read {0}: {1}.": "{0} kann nicht gelesen werden: {1}.",
    "{0} can't be the name of a file.": "{0} kann nicht der Name einer Datei sein.",
    "{0} is too large to be read; scale it down to at most 20,000 px a side.": (
        "{0} ist zu groß, um gelesen zu werden; auf höchstens 20.000 px je Seite verkleinern."
    ),
    "{0} is only {1} x {2} px; give a picture of at least {3} x {4} px.": (
        "{0} hat nur {1} x {2} px; ein Bild von mindestens {3} x {4} px geben."
    ),
    "{0} is {1} x {2} px; scale it down to at most {3} px a side.": (
        "{0} hat {1} x {2} px; auf höchstens {3} px je Seite verkleinern."
    ),
    "{0} holds values that aren't numbers; replace the NaN first.": (
        "{0} enthält Werte, die keine Zahlen sind; zuerst die NaN ersetzen."
    ),
    "The picture is black all over; scan the page again, or choose polarity 'light' if "
    "it is an empty blackboard.": (
        "Das Bild ist überall schwarz; die Seite noch einmal scannen, oder bei einer leeren "
        "Tafel --polarity light wählen."
    ),
    "{0} says it has {1} images; it is damaged.": (
        "{0} sagt, es habe {1} Bilder; es ist beschädigt."
    ),
    "{0} has no image {1} that can be read.": "{0} hat kein lesbares Bild {1}.",
    "{0} is not a movie that can be read.": "{0} ist kein Film, der gelesen werden kann.",
    "the PSD holds no flattened picture; save it with 'Maximize Compatibility', or as PNG.": (
        "die PSD enthält kein flaches Bild; sie mit „Kompatibilität maximieren“ oder als PNG "
        "speichern."
    ),
    "The weights of the centerline network ({0}) are missing; reinstall Involute, or "
    "choose the classical provider.": (
        "Die Gewichte der Liniensuche ({0}) fehlen; Involute neu installieren oder "
        "--provider classical wählen."
    ),
    "Found no GPU that torch can use; choose the device 'auto' or 'cpu'.": (
        "Keine Grafikkarte gefunden, die torch benutzen kann; --device auto oder --device "
        "cpu wählen."
    ),
    "Can't read the weights in {0}.": "Die Gewichte in {0} können nicht gelesen werden.",
    "The weights of the routing network are missing or damaged.": (
        "Die Gewichte des Netzes für Kreuzungen fehlen oder sind beschädigt."
    ),
    "The names {0} and {1} are not of one sequence; give the files of one sequence.": (
        "Die Namen {0} und {1} gehören nicht zu einer Bildfolge; die Dateien einer Bildfolge geben."
    ),
    "The names {0} and {1} differ in more than one number; give the files of one sequence.": (
        "Die Namen {0} und {1} unterscheiden sich in mehr als einer Zahl; die Dateien einer "
        "Bildfolge geben."
    ),
    "{0} and {1} are both drawing {2}; give the files of one sequence.": (
        "{0} und {1} sind beide Zeichnung {2}; die Dateien einer Bildfolge geben."
    ),
    "Frame {0} is beyond what a timeline holds ({1}); choose another start or step.": (
        "Bild {0} liegt jenseits dessen, was eine Zeitleiste fasst ({1}); anderen Anfang "
        "oder Abstand wählen."
    ),
    "{0} declares entities; save it as plain SVG first.": (
        "{0} erklärt Entitäten; zuerst als einfaches SVG speichern."
    ),
    "There is no line in {0}; pictures inside of an SVG are not read.": (
        "In {0} ist keine Linie; Bilder in einem SVG werden nicht gelesen."
    ),
    "{0} isn't an SVG that can be read ({1}); save it anew.": (
        "{0} ist kein lesbares SVG ({1}); neu speichern."
    ),
    "Frame {frame}:  {count} doubts": "Bild {frame}:  {count} Zweifel",
    "Most to Review": "Am meisten zu prüfen",
    "Go to this keyframe": "Zu diesem Keyframe gehen",
    "Go to Keyframe": "Zum Keyframe",
    "Number of the frame": "Nummer des Bildes",
    "Trace the picture, or the picture file, that is in the clipboard": (
        "Das Bild oder die Bilddatei nachziehen, die in der Zwischenablage ist"
    ),
    "Trace from Clipboard": "Aus der Zwischenablage nachziehen",
    "Drawing from Clipboard": "Zeichnung aus der Zwischenablage",
    "Blender sees no picture in the clipboard; save it as a file, and drop that on the viewport.": (
        "Blender sieht kein Bild in der Zwischenablage; es als Datei speichern und diese auf "
        "den Viewport ziehen."
    ),
    # frames
    "Frame": "Bild",
    # small parts
    "Small Parts": "Kleine Teile",
    "Put what hangs together and is smaller than this many pen widths, such as "
    "lettering, on layers of its own; 0 doesn't": (
        "Was zusammenhängt und kleiner ist als so viele Strichbreiten, etwa Schrift, auf "
        "eigene Ebenen legen; 0 tut es nicht"
    ),
    # a part of a page
    "Drag a box over the scan to see what the settings do there; each change shows at once": (
        "Einen Rahmen über den Scan ziehen und sehen, was die Einstellungen dort tun; jede "
        "Änderung zeigt sich sofort"
    ),
    "Try on a Part": "An einem Teil probieren",
    "Drag a box over the scan, or click it; Esc leaves": (
        "Einen Rahmen über den Scan ziehen oder ihn anklicken; Esc bricht ab"
    ),
    "Drag a box over the picture.": "Einen Rahmen über das Bild ziehen.",
    "Select an image Empty, or a drawing that was traced.": (
        "Ein Bild-Empty oder eine nachgezogene Zeichnung auswählen."
    ),
    "The picture isn't as large as what you see of it; trace it as a new object.": (
        "Das Bild ist nicht so groß wie das, was davon zu sehen ist; es als neues Objekt "
        "nachziehen."
    ),
    "The lines of an SVG are taken as they are; there is no scan.": (
        "Die Linien eines SVG werden genommen, wie sie sind; es gibt keinen Scan."
    ),
    "Trace a part of the picture with the settings of the sidebar, to see what they do": (
        "Einen Teil des Bildes mit den Einstellungen der Seitenleiste nachziehen und sehen, "
        "was sie tun"
    ),
    "Trace a Part": "Einen Teil nachziehen",
    "Left, top, right and bottom of the part, in pixels of the scan; the part that is "
    "shown already, if it isn't given": (
        "Links, oben, rechts und unten des Teils, in Pixeln des Scans; ohne Angabe der Teil, "
        "der schon zu sehen ist"
    ),
    "Take the traced part away; nothing of it stays": (
        "Den nachgezogenen Teil wegnehmen; nichts davon bleibt"
    ),
    "Remove": "Entfernen",
    "Make a Grease Pencil object of the traced part": (
        "Aus dem nachgezogenen Teil ein Grease-Pencil-Objekt machen"
    ),
    "Keep as Object": "Als Objekt behalten",
    "Part: {count} strokes": "Teil: {count} Striche",
    # paper
    "Show the picture, paled and on paper, behind the strokes that were traced from it": (
        "Das Bild, blass und auf Papier, hinter den Strichen zeigen, die aus ihm nachgezogen wurden"
    ),
    "Paper": "Papier",
}
