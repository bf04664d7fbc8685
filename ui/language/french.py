"""French texts of the interface by their English ones; places in {braces} stay as they are."""

from __future__ import annotations

TEXTS = {
    # pencil and its lines
    "Merge to One Line": "Fusionner en une ligne",
    "Make one line of the selected strokes, in the middle of them; pencil strokes stay": (
        "Faire une seule ligne des traits sélectionnés, en leur milieu ; "
        "les traits de crayon restent"
    ),
    "Split into Pencil Strokes": "Séparer en traits de crayon",
    "Put the pencil strokes that say a line in its place, for all selected lines": (
        "Remplacer chaque ligne sélectionnée par les traits de crayon dont elle est faite"
    ),
    "Select two or more strokes that are one line.": (
        "Sélectionnez au moins deux traits qui forment une ligne."
    ),
    "Select lines that were made of pencil strokes.": (
        "Sélectionnez des lignes faites de traits de crayon."
    ),
    "Trace Drawing": "Vectoriser un dessin",
    "Turn a scanned drawing into Grease Pencil strokes that run straight through junctions": (
        "Transformer un dessin numérisé en traits de crayon gras qui traversent les jonctions "
        "tout droit"
    ),
    "File": "Fichier",
    "Picture to trace; empty for the image given below or the active image Empty": (
        "Image à vectoriser ; vide pour l'image indiquée ci-dessous ou l'Empty image actif"
    ),
    "Image": "Image",
    "Name of the image data-block to trace": "Nom du bloc de données image à vectoriser",
    "Target": "Cible",
    "Where the strokes go": "Où vont les traits",
    "New Object": "Nouvel objet",
    "A Grease Pencil object per drawing": "Un objet crayon gras par dessin",
    "Active Object": "Objet actif",
    "A keyframe of the active Grease Pencil object": "Une image clé de l'objet crayon gras actif",
    "Trace scanned drawings from files as Grease Pencil strokes": (
        "Vectoriser des dessins numérisés depuis des fichiers en traits de crayon gras"
    ),
    "Trace Scanned Drawings": "Vectoriser des dessins numérisés",
    "Trace {name}": "Vectoriser {name}",
    "Trace What {name} Plays": "Vectoriser ce que joue {name}",
    "Trace Files...": "Vectoriser des fichiers...",
    "Trace Sequence...": "Vectoriser une séquence...",
    "Trace as Grease Pencil": "Vectoriser en crayon gras",
    "Scanned Drawing as Grease Pencil (Involute)": "Dessin numérisé en crayon gras (Involute)",
    "Drawing Sequence as Grease Pencil (Involute)": "Séquence de dessins en crayon gras (Involute)",
    "Scanned Drawing...": "Dessin numérisé...",
    "Drawing Sequence...": "Séquence de dessins...",
    "Trace as Keyframes (Involute)": "Vectoriser en images clés (Involute)",
    "Trace as Strokes (Involute)": "Vectoriser en traits (Involute)",
    "Cancel": "Annuler",
    "Stop the trace that is running; nothing in the scene changes": (
        "Arrêter la vectorisation en cours ; rien ne change dans la scène"
    ),
    "{stage}, {percent} % (Esc cancels)": "{stage}, {percent} % (Échap annule)",
    "Reading the picture": "Lecture de l'image",
    "Looking for solid blacks": "Recherche des aplats noirs",
    "Finding the lines": "Recherche des lignes",
    "Finding the junctions": "Recherche des jonctions",
    "Routing the junctions": "Routage des jonctions",
    "Drawing the strokes": "Tracé des traits",
    "Comparing with the ink": "Comparaison avec l'encre",
    "{done} of {count} frames": "{done} images sur {count}",
    "Result": "Résultat",
    "{strokes:,} strokes, {solids:,} solids, {seconds:.1f} s": (
        "{strokes:,} traits, {solids:,} aplats, {seconds:.1f} s"
    ),
    "{junctions:,} junctions, {bundles:,} bundles, {doubtful:,} doubtful": (
        "{junctions:,} jonctions, {bundles:,} faisceaux, {doubtful:,} douteux"
    ),
    (
        "{strokes} strokes, {junctions} junctions and {bundles} bundles "
        "({doubtful} doubtful), {seconds:.1f} s"
    ): (
        "{strokes} traits, {junctions} jonctions et {bundles} faisceaux "
        "({doubtful} douteux), {seconds:.1f} s"
    ),
    "{junctions:,} junctions, {doubtful:,} doubtful": (
        "{junctions:,} jonctions, {doubtful:,} douteuses"
    ),
    "{strokes} strokes, {junctions} junctions ({doubtful} doubtful), {seconds:.1f} s": (
        "{strokes} traits, {junctions} jonctions ({doubtful} douteuses), {seconds:.1f} s"
    ),
    "Another trace is running; wait for it or cancel it.": (
        "Une autre vectorisation est en cours ; attendez-la ou annulez-la."
    ),
    "Tracing was cancelled.": "La vectorisation a été annulée.",
    "There is nothing to trace.": "Il n'y a rien à vectoriser.",
    "There are no lines in the picture.": "Il n'y a pas de lignes dans l'image.",
    "There is no image {name!r} in this file.": "Il n'y a pas d'image {name!r} dans ce fichier.",
    "The image {name!r} has no pixels; reload it or choose another.": (
        "L'image {name!r} n'a pas de pixels ; rechargez-la ou choisissez-en une autre."
    ),
    "Choose a picture file, or select an Empty that shows an image.": (
        "Choisissez un fichier image, ou sélectionnez un Empty qui montre une image."
    ),
    "Make a Grease Pencil object of this file the active one.": (
        "Rendez actif un objet crayon gras de ce fichier."
    ),
    "There is not enough memory for a picture of this size.": (
        "Il n'y a pas assez de mémoire pour une image de cette taille."
    ),
    "What the Drawing Is": "Nature du dessin",
    "How Clean": "Propreté",
    "How Many Points": "Nombre de points",
    "Whether every line is drawn once or by many pencil strokes": (
        "Si chaque ligne est tracée une fois ou par plusieurs traits de crayon"
    ),
    "Rough where many lines run beside themselves": (
        "Esquisse là où beaucoup de lignes se doublent"
    ),
    "Clean": "Propre",
    "Every line is drawn once": "Chaque ligne est tracée une fois",
    "Rough": "Esquisse",
    "Many pencil strokes say one line: find that line": (
        "Plusieurs traits de crayon disent une ligne : trouver cette ligne"
    ),
    "Lines": "Lignes",
    "Which side of the picture is ink": "Quel côté de l'image est l'encre",
    "Find out from the picture": "Le déduire de l'image",
    "Dark on Light": "Sombre sur clair",
    "Ink or pencil on paper": "Encre ou crayon sur papier",
    "Light on Dark": "Clair sur sombre",
    "Chalk, blueprints, inverted scans": "Craie, bleus d'architecte, images inversées",
    "Pen Width": "Largeur de plume",
    "Usual width of a line in pixels of the picture; 0 measures it": (
        "Largeur habituelle d'une ligne en pixels de l'image ; 0 la mesure"
    ),
    "Line Finder": "Détection des lignes",
    "What finds the centres of the lines": "Ce qui trouve le milieu des lignes",
    "The trained network when it is there, else the ridge filter": (
        "Le réseau entraîné s'il est là, sinon le filtre de crêtes"
    ),
    "Network": "Réseau",
    "Trained on pencil, ink, chalk and bad scans": (
        "Entraîné sur crayon, encre, craie et mauvaises numérisations"
    ),
    "Grain": "Grain",
    "From how far the page is looked at, so that grainy lines are whole": (
        "De quelle distance la page est regardée, pour que les traits grenus restent entiers"
    ),
    "Closely, and where soft lines are torn from afar as well; the simpler drawing is kept": (
        "De près, et de loin aussi si des traits doux sont déchirés ; le plus simple est gardé"
    ),
    "As close as the pen is wide: ink, markers, clean pencil": (
        "Aussi près que la plume est large : encre, feutre, crayon net"
    ),
    "At 0.7 of that size: soft pencil, crayon": "À 0,7 de cette taille : crayon gras, pastel",
    "At 0.55 of that size: charcoal, chalk, rough paper": (
        "À 0,55 de cette taille : fusain, craie, papier rugueux"
    ),
    "Fine": "Fin",
    "Medium": "Moyen",
    "Coarse": "Grossier",
    "The lines are grainy: traced from farther away (--grain {0}).": (
        "Les traits sont grenus : tracé de plus loin (--grain {0})."
    ),
    "Coarsest": "Le plus grossier",
    "At 0.4 of that size: what falls to shreds even so": (
        "À 0,4 de cette taille : ce qui reste en lambeaux malgré tout"
    ),
    "Lean Network": "Réseau léger",
    "Smaller, in three quarters of the time; cuts grainy lines more": (
        "Plus petit, en trois quarts du temps ; coupe davantage les traits granuleux"
    ),
    "Ridge Filter": "Filtre de crêtes",
    "No learning; for very clean lines": "Sans apprentissage ; pour des lignes très propres",
    "Picture Is Centerlines": "L'image est faite de lignes médianes",
    "Thin white lines on black, made elsewhere": "Fines lignes blanches sur noir, faites ailleurs",
    "Solid Blacks": "Aplats noirs",
    "Turn areas of solid ink into fills instead of tracing them as lines": (
        "Faire des zones d'encre pleine des remplissages au lieu de les vectoriser comme lignes"
    ),
    "Ink Colors": "Couleurs d'encre",
    "Give every ink its own layer and material; off draws all lines in black": (
        "Donner à chaque encre son calque et son matériau ; sinon toutes les lignes sont noires"
    ),
    "Ignore Inks": "Ignorer des encres",
    "Inks that are not traced, such as a blue construction pencil": (
        "Encres qui ne sont pas vectorisées, comme un crayon bleu de construction"
    ),
    "None": "Aucune",
    "Don't trace lines of this color": "Ne pas vectoriser les lignes de cette couleur",
    "Red": "Rouge",
    "Orange": "Orange",
    "Yellow": "Jaune",
    "Green": "Vert",
    "Cyan": "Cyan",
    "Blue": "Bleu",
    "Purple": "Violet",
    "Pink": "Rose",
    "Gray": "Gris",
    "Solid Width": "Largeur des aplats",
    "Leave Out Rules": "Exclure les réglures",
    "Don't trace the printed lines of ruled and squared paper": (
        "Ne pas vectoriser les lignes imprimées du papier réglé ou quadrillé"
    ),
    "Leave Out Screentone": "Exclure les trames",
    "Don't trace areas of evenly set dots, such as the tones of a comic": (
        "Ne pas vectoriser les zones de points réguliers, comme les trames d'une bande dessinée"
    ),
    "Leave Out Surroundings": "Exclure les alentours",
    "Don't trace what lies beyond the sheet in a photograph: cloth, a desk, a finger": (
        "Ne pas vectoriser ce qui dépasse de la feuille sur une photo : tissu, table, doigt"
    ),
    "Straighten Sheet": "Redresser la feuille",
    "Take the perspective out of a photographed sheet, as seen from straight above": (
        "Supprimer la perspective d'une feuille photographiée, comme vue d'en haut"
    ),
    "Leave Out the Back": "Omettre le verso",
    "Don't trace what shows through from the back of the sheet, paler and softer": (
        "Ne pas tracer ce qui transparaît du verso de la feuille, plus pâle et plus flou"
    ),
    "Lines wider than this, in pixels of the picture, are solid areas; 0 finds out from the pen": (
        "Les lignes plus larges, en pixels de l'image, sont des aplats ; 0 le déduit de la plume"
    ),
    "Keep Dots": "Garder les points",
    "Keep dots of full ink about as wide as the pen, which are no specks": (
        "Garder les points d'encre pleine à peu près aussi larges que la plume, qui ne sont pas "
        "des taches"
    ),
    "Join Dashes": "Joindre les tirets",
    "Make one stroke of a dashed or dotted line, and note how it is dashed": (
        "Faire un seul trait d'une ligne tiretée ou pointillée, et noter ses tirets"
    ),
    "Opacity": "Opacité",
    "How opaque the strokes are": "Opacité des traits",
    "Solid": "Pleine",
    "Solid for ink, as drawn for pencil": "Pleine pour l'encre, comme dessinée pour le crayon",
    "Every stroke is opaque": "Chaque trait est opaque",
    "As Drawn": "Comme dessinée",
    "As strong as the line on the paper": "Aussi forte que la ligne sur le papier",
    "Width Scale": "Échelle de largeur",
    "Make the strokes this many times as wide as the lines on the paper": (
        "Multiplier la largeur des lignes du papier par ce facteur pour les traits"
    ),
    "Even Width": "Largeur égale",
    "Give each stroke one width all along, that of its line on average": (
        "Donner à chaque trait une seule largeur, la moyenne de sa ligne"
    ),
    "Leave Out Marks": "Exclure les repères",
    "Don't trace scan borders, punched holes and registration marks": (
        "Ne pas vectoriser les bords de numérisation, les perforations et les croix de repérage"
    ),
    "Fill Regions": "Remplir les régions",
    "Fill the closed regions between the lines, on a layer below": (
        "Remplir les régions fermées entre les lignes, sur un calque en dessous"
    ),
    "Specks": "Taches",
    "Drop lone strokes shorter than this many pen widths": (
        "Supprimer les traits isolés plus courts que ce nombre de largeurs de plume"
    ),
    "Smoothing": "Lissage",
    "0 keeps every wobble of the hand, 1 is very smooth": (
        "0 garde chaque tremblement de la main, 1 est très lisse"
    ),
    "Pen Lifts": "Levers de plume",
    "Where strokes end though only two lines meet: -1 nowhere, 0 where it looks as if the pen "
    "was lifted, 1 wherever it may have been": (
        "Où les traits s'arrêtent bien que deux lignes seulement se rencontrent : -1 nulle part, "
        "0 où la plume semble levée, 1 partout où elle peut l'avoir été"
    ),
    "Junctions": "Jonctions",
    "What decides which lines continue through a junction": (
        "Ce qui décide quelles lignes continuent à travers une jonction"
    ),
    "The trained network when it is there, else geometry": (
        "Le réseau entraîné s'il est là, sinon la géométrie"
    ),
    "Looks at the whole neighborhood of the junction": "Regarde tout le voisinage de la jonction",
    "Geometry": "Géométrie",
    "Looks at direction, curvature and width only": (
        "Ne regarde que la direction, la courbure et la largeur"
    ),
    "Tolerance": "Tolérance",
    "How far a stroke may stray from the traced line, in pixels of the picture; more gives fewer "
    "points": (
        "De combien un trait peut s'écarter de la ligne vectorisée, en pixels de l'image ; plus "
        "donne moins de points"
    ),
    "Curves": "Courbes",
    "What the strokes are made of": "De quoi sont faits les traits",
    "Points": "Points",
    "Plain points, for sculpting and drawing over": "Simples points, à sculpter et à redessiner",
    "Bézier": "Bézier",
    "Few points with handles": "Peu de points, avec des poignées",
    "Device": "Calcul sur",
    "Where the networks run": "Où tournent les réseaux",
    "A graphics card when one can be used, else the processor": (
        "Une carte graphique si l'on peut, sinon le processeur"
    ),
    "Processor": "Processeur",
    "Always works": "Marche toujours",
    "Graphics Card": "Carte graphique",
    "Needs PyTorch in Blender's Python": "Demande PyTorch dans le Python de Blender",
    "Reset to Defaults": "Rétablir les défauts",
    "Set all trace settings back to the defaults that are in the preferences": (
        "Remettre tous les réglages de vectorisation aux défauts des préférences"
    ),
    "Trace Preset": "Préréglage de vectorisation",
    "Trace Presets": "Préréglages de vectorisation",
    "Add or remove a preset of the trace settings": (
        "Ajouter ou enlever un préréglage de vectorisation"
    ),
    "Place": "Emplacement",
    "Where a new drawing stands; on an image Empty it always lies on the image": (
        "Où se place un nouveau dessin ; sur un Empty image il est toujours sur l'image"
    ),
    "Front View": "Vue de face",
    "Automatic": "Automatique",
    "Fit to the camera while you look through it, else front view": (
        "Ajuster à la caméra quand on regarde à travers elle, sinon vue de face"
    ),
    "Upright at the world's origin, before what stands there": (
        "Debout à l'origine du monde, devant ce qui s'y trouve"
    ),
    "Scan Behind": "Image derrière",
    "Where It Goes": "Où cela va",
    "Scan": "Numérisation",
    "Fit to Camera": "Ajuster à la caméra",
    "Fill the view of the scene's camera, facing it": (
        "Remplir la vue de la caméra de la scène, face à elle"
    ),
    "Drawing Plane": "Plan de dessin",
    "As the scene's Stroke Placement and Drawing Plane say": (
        "Selon le placement des traits et le plan de dessin de la scène"
    ),
    "Pixels per Metre": "Pixels par mètre",
    "Size of a new drawing; 0 makes it 2 metres tall. Fit to Camera ignores it": (
        "Taille d'un nouveau dessin ; 0 lui donne 2 mètres de haut. Ajuster à la caméra l'ignore"
    ),
    "There is no camera in the scene to fit to; add one, or place it else.": (
        "Il n'y a pas de caméra dans la scène à laquelle ajuster ; ajoutez-en une, ou placez "
        "autrement."
    ),
    "Trace Sequence": "Vectoriser une séquence",
    "Turn numbered drawings into keyframes of one Grease Pencil object, in the background": (
        "Faire de dessins numérotés les images clés d'un objet crayon gras, en arrière-plan"
    ),
    "Trace Drawing Sequence": "Vectoriser une séquence de dessins",
    "Choose a folder of numbered drawings, or some of them, and trace them as keyframes": (
        "Choisir un dossier de dessins numérotés, ou quelques-uns, et les vectoriser en images clés"
    ),
    "Start At": "Commencer à",
    "Put the first drawing at a frame of your choice instead of its own number": (
        "Mettre le premier dessin à une image de votre choix au lieu de son propre numéro"
    ),
    "Start Frame": "Image de début",
    "Frame of the first drawing": "Image du premier dessin",
    "Step": "Pas",
    "Frames from one number to the next; 2 animates on twos": (
        "Images d'un numéro au suivant ; 2 anime en deux"
    ),
    "Align by Peg Holes": "Aligner par les perforations",
    "Bring all pages to where the peg holes or registration marks of the first lie": (
        "Amener toutes les pages là où sont les perforations ou repères de la première"
    ),
    "Steady Strokes": "Traits stables",
    "Give neighboring frames the same order and direction of strokes, so that Interpolate pairs "
    "them rightly": (
        "Donner aux images voisines le même ordre et la même direction de traits, pour "
        "qu'Interpoler les apparie bien"
    ),
    "Processes": "Processus",
    "Drawings traced at the same time; 0 uses every processor core": (
        "Dessins vectorisés en même temps ; 0 utilise tous les cœurs"
    ),
    "Folder": "Dossier",
    "Folder of numbered drawings; empty for what the active image Empty plays": (
        "Dossier de dessins numérotés ; vide pour ce que joue l'Empty image actif"
    ),
    "Only What Changed": "Seulement ce qui a changé",
    "Fill the active object; keyframes whose drawing has not changed stay as they are, with all "
    "that was done to them": (
        "Remplir l'objet actif ; les images clés dont le dessin n'a pas changé restent telles "
        "quelles, avec tout ce qui leur a été fait"
    ),
    "Choose a folder of drawings, or select an Empty that plays images or a movie.": (
        "Choisissez un dossier de dessins, ou sélectionnez un Empty qui joue des images ou un film."
    ),
    "Make the Grease Pencil object of the sequence the active one.": (
        "Rendez actif l'objet crayon gras de la séquence."
    ),
    "None of the frames could be traced.": "Aucune des images n'a pu être vectorisée.",
    "Frame {frame}": "Image {frame}",
    "{count} keyframes": "{count} images clés",
    "{count} kept": "{count} gardées",
    "{count} frames failed": "{count} images en échec",
    "then cancelled": "puis annulé",
    "There is no folder {path}; check the path.": (
        "Il n'y a pas de dossier {path} ; vérifiez le chemin."
    ),
    "There is no picture in {path}; choose another folder.": (
        "Il n'y a pas d'image dans {path} ; choisissez un autre dossier."
    ),
    "{name} plays no frame; set its Frames to more than 0.": (
        "{name} ne joue aucune image ; mettez son nombre d'images au-dessus de 0."
    ),
    "There is no folder {path}; find the images again.": (
        "Il n'y a pas de dossier {path} ; retrouvez les images."
    ),
    "There is no file {path}; find the images again.": (
        "Il n'y a pas de fichier {path} ; retrouvez les images."
    ),
    "Sort": "Trier",
    "Order of the list": "Ordre de la liste",
    "Doubt": "Doute",
    "The most doubtful first": "Les plus douteuses d'abord",
    "From the top of the page to the bottom": "Du haut de la page vers le bas",
    "Doubtful": "Douteuses",
    "List doubtful junctions only": "Ne montrer que les jonctions douteuses",
    "Unlocked": "Non verrouillées",
    "Leave out junctions that you have fixed": "Omettre les jonctions que vous avez fixées",
    "How many lines meet": "Combien de lignes se rencontrent",
    "Any": "Toutes",
    "Any number of lines": "N'importe quel nombre de lignes",
    "Three lines meet": "Trois lignes se rencontrent",
    "Four lines meet": "Quatre lignes se rencontrent",
    "Five or more lines meet": "Cinq lignes ou plus se rencontrent",
    "Page": "Page",
    "Page of the list": "Page de la liste",
    "Page of {count}": "Page sur {count}",
    "{some} of {all}": "{some} sur {all}",
    "{count} lines": "{count} lignes",
    "Bundle": "Faisceau",
    "One line": "Une ligne",
    "Two lines": "Deux lignes",
    "Pencil strokes beside each other: one line or two": (
        "Traits de crayon côte à côte : une ligne ou deux"
    ),
    "No junction passes the filters": "Aucune jonction ne passe les filtres",
    "No junction passes the filters.": "Aucune jonction ne passe les filtres.",
    "Previous": "Précédente",
    "Next": "Suivante",
    "Direction": "Direction",
    "Which way along the list": "Dans quel sens de la liste",
    "The next junction of the list": "La jonction suivante de la liste",
    "The junction before in the list": "La jonction précédente de la liste",
    "Next or Previous Junction": "Jonction suivante ou précédente",
    "Go to the next or previous junction of the list": (
        "Aller à la jonction suivante ou précédente de la liste"
    ),
    "Go to Junction": "Aller à la jonction",
    "Look at this junction": "Regarder cette jonction",
    "Move View": "Déplacer la vue",
    "Bring the junction to the middle of the view": "Amener la jonction au milieu de la vue",
    "Above": "Au-dessus de",
    "Accept {count}": "En accepter {count}",
    "Stroke Colors": "Couleurs des traits",
    "Strokes": "Traits",
    "Show every stroke in a color of its own, with its ends marked": (
        "Montrer chaque trait dans sa propre couleur, avec ses extrémités marquées"
    ),
    "Stroke Width": "Largeur des traits",
    "Width of a stroke that is shown in a color of its own, in pixels": (
        "Largeur d'un trait montré dans sa propre couleur, en pixels"
    ),
    "One of the colors that tell strokes apart": "Une des couleurs qui distinguent les traits",
    "Stroke Color 1": "Couleur de trait 1",
    "Stroke Color 2": "Couleur de trait 2",
    "Stroke Color 3": "Couleur de trait 3",
    "Stroke Color 4": "Couleur de trait 4",
    "Stroke Color 5": "Couleur de trait 5",
    "Stroke Color 6": "Couleur de trait 6",
    "Accept Certain Junctions": "Accepter les jonctions sûres",
    "Lock every junction that is at least this certain": (
        "Verrouiller chaque jonction au moins aussi sûre"
    ),
    "Certainty": "Certitude",
    "Least probability of the routing in force": "Probabilité minimale du routage en vigueur",
    "{count} junctions accepted": "{count} jonctions acceptées",
    "Ask Again": "Redemander",
    "Route all junctions that are not locked again, given what you have fixed": (
        "Router de nouveau toutes les jonctions non verrouillées, d'après ce que vous avez fixé"
    ),
    "{count} junctions changed": "{count} jonctions changées",
    "Current Junction": "Jonction courante",
    "Junction": "Jonction",
    "Number of the junction": "Numéro de la jonction",
    "Number of the junction; -1 is the current one": "Numéro de la jonction ; -1 est la courante",
    "Alternative": "Possibilité",
    "Which alternative": "Quelle possibilité",
    "Which alternative, the most probable is 0": "Quelle possibilité, la plus probable est 0",
    "{lines} ends": "{lines} s'arrête",
    "{lines} end": "{lines} s'arrêtent",
    "Lock Junction": "Verrouiller la jonction",
    "Lock the junction: it counts as certain, and Ask Again learns from it; or unlock it": (
        "Verrouiller la jonction : elle compte comme sûre, et Redemander apprend d'elle ; ou la "
        "déverrouiller"
    ),
    "Lock or Unlock": "Verrouiller ou déverrouiller",
    "Preview Alternative": "Aperçu de la possibilité",
    "Show this alternative in the viewport without applying it; again to stop": (
        "Montrer cette possibilité dans la vue sans l'appliquer ; encore une fois pour cesser"
    ),
    "Reroute Junction": "Rerouter la jonction",
    "Let the lines continue through the junction in this way; only they change": (
        "Faire continuer les lignes ainsi à travers la jonction ; elles seules changent"
    ),
    "Choose in Viewport": "Choisir dans la vue",
    "Choose Routing": "Choisir le routage",
    "Show the alternatives of a junction as cards: point to preview, click to apply": (
        "Montrer les possibilités d'une jonction en cartes : pointer pour l'aperçu, cliquer pour "
        "appliquer"
    ),
    "Point at a card to preview, click or Enter to apply, wheel or arrows for the next, L locks, "
    "Esc leaves": (
        "Pointez une carte pour l'aperçu, clic ou Entrée applique, molette ou flèches pour la "
        "suivante, L verrouille, Échap quitte"
    ),
    "Pick": "Pointer",
    "Take the junction under the mouse instead of the current one": (
        "Prendre la jonction sous la souris au lieu de la courante"
    ),
    "By Hand": "À la main",
    "Join Lines": "Joindre des lignes",
    "Let one of these lines continue in the other; what they continued in before ends here": (
        "Faire continuer une de ces lignes dans l'autre ; ce qu'elles continuaient avant "
        "s'arrête ici"
    ),
    "First": "Première",
    "Second": "Seconde",
    "Number of a half-branch": "Numéro d'une demi-branche",
    "Number of the other half-branch": "Numéro de l'autre demi-branche",
    "Ends": "S'arrête",
    "Separate Lines": "Séparer des lignes",
    "Separate All Lines": "Séparer toutes les lignes",
    "End a line at its junction, or all lines of the current junction": (
        "Arrêter une ligne à sa jonction, ou toutes les lignes de la jonction courante"
    ),
    "Line": "Ligne",
    "Number of the half-branch; -1 separates all": (
        "Numéro de la demi-branche ; -1 les sépare toutes"
    ),
    "Drag to Join": "Glisser pour joindre",
    "Choose a junction first.": "Choisissez d'abord une jonction.",
    "This junction has {count} alternatives.": "Cette jonction a {count} possibilités.",
    "Select a drawing that Involute has traced": "Sélectionnez un dessin qu'Involute a vectorisé",
    "This drawing is linked from another file; make it local to change it.": (
        "Ce dessin est lié depuis un autre fichier ; rendez-le local pour le changer."
    ),
    "This drawing was not traced by Involute.": "Ce dessin n'a pas été vectorisé par Involute.",
    "A newer Involute traced this drawing; update the extension.": (
        "Un Involute plus récent a vectorisé ce dessin ; mettez l'extension à jour."
    ),
    "A stroke at this junction was changed so much that its ends can't be told; nothing was "
    "changed.": (
        "Un trait à cette jonction a tant changé que ses extrémités ne se reconnaissent plus ; "
        "rien n'a été changé."
    ),
    "Drawing": "Dessin",
    "The traced drawing that is looked at": "Le dessin vectorisé que l'on regarde",
    "The current junction": "La jonction courante",
    "Preview": "Aperçu",
    "The alternative that is shown but not applied": (
        "La possibilité qui est montrée mais pas appliquée"
    ),
    "Choosing": "Choix en cours",
    "The cards of the alternatives are shown": "Les cartes des possibilités sont montrées",
    "Junction Overlay": "Jonctions en surimpression",
    "Show junctions in the viewport, colored by doubt": (
        "Montrer les jonctions dans la vue, colorées selon le doute"
    ),
    "Defaults": "Défauts",
    "Trace settings that Reset to Defaults brings back": (
        "Réglages de vectorisation que Rétablir les défauts ramène"
    ),
    "Certain": "Sûre",
    "Color of junctions that are certain": "Couleur des jonctions qui sont sûres",
    "Color of the most doubtful junctions": "Couleur des jonctions les plus douteuses",
    "Locked": "Verrouillée",
    "Color of junctions that you have fixed": "Couleur des jonctions que vous avez fixées",
    "Ring Size": "Taille des anneaux",
    "Radius of a certain junction's ring, in pen widths": (
        "Rayon de l'anneau d'une jonction sûre, en largeurs de plume"
    ),
    "Default Trace Settings": "Réglages de vectorisation par défaut",
    "Keys in the 3D Viewport": "Touches de la vue 3D",
    "Networks": "Réseaux",
    "Line finder": "Détection des lignes",
    "Lean line finder": "Détection légère des lignes",
    "Junction router": "Routage des jonctions",
    "not installed: the method without learning is used": (
        "pas installé : la méthode sans apprentissage est utilisée"
    ),
    "Choose one picture file or several.": "Choisissez un ou plusieurs fichiers image.",
    "Review Junctions": "Passer les jonctions en revue",
    "Decide the doubtful junctions one after the other, those first where most depends on it": (
        "Décider les jonctions douteuses l'une après l'autre, d'abord celles dont le plus dépend"
    ),
    "No junction is doubtful any more.": "Aucune jonction n'est plus douteuse.",
    "A review needs a 3D viewport.": "Une revue demande une vue 3D.",
    "Cost": "Coût",
    "Doubt times the length of stroke that another answer changes": (
        "Le doute fois la longueur de trait qu'une autre réponse change"
    ),
    "Use Preset": "Utiliser le préréglage",
    "Set all trace settings to what suits a kind of drawing": (
        "Régler toute la vectorisation pour un genre de dessin"
    ),
    "Preset": "Préréglage",
    "What kind of drawing it is": "Quel genre de dessin c'est",
    "Ink": "Encre",
    "Pen drawings on paper; the defaults": "Dessins à la plume sur papier ; les défauts",
    "Pencil": "Crayon",
    "Soft lines of changing darkness, crumbs left out; no solid blacks": (
        "Lignes douces de force changeante, miettes omises ; pas d'aplats noirs"
    ),
    "Brush and Marker": "Pinceau et feutre",
    "Broad, swelling lines in few points, thick places not taken for solids": (
        "Lignes larges et modulées en peu de points, les endroits épais ne sont pas pris pour "
        "des aplats"
    ),
    "Blueprint": "Bleu d'architecte",
    "Light lines on dark paper, all in one ink, corners kept sharp": (
        "Lignes claires sur papier sombre, toutes en une encre, coins gardés vifs"
    ),
    "Binarised Animation Lines": "Lignes d'animation binarisées",
    "Hard black and colored lines without grey, closed regions filled": (
        "Lignes dures, noires et en couleurs, sans gris, régions fermées remplies"
    ),
    "Comic Page": "Page de bande dessinée",
    "Ink with solid blacks, all in one ink, specks of the print left out": (
        "Encre avec aplats noirs, tout en une encre, taches d'impression omises"
    ),
    "Next Junction": "Jonction suivante",
    "Previous Junction": "Jonction précédente",
    "This drawing has no junctions any more: what was stored of them is damaged. Its strokes "
    "stay as they are.": (
        "Ce dessin n'a plus de jonctions : ce qui en était gardé est endommagé. Ses traits "
        "restent tels quels."
    ),
    "The strokes at this junction were deleted, or joined by hand; nothing was changed.": (
        "Les traits à cette jonction ont été supprimés, ou joints à la main ; rien n'a été changé."
    ),
    "The layer {name!r} is locked; unlock it to reroute.": (
        "Le calque {name!r} est verrouillé ; déverrouillez-le pour rerouter."
    ),
    "Cut Strokes": "Couper des traits",
    "Cut the strokes that a path crosses there; the cuts are decisions of yours and stay": (
        "Couper là les traits qu'un tracé croise ; les coupes sont vos décisions et restent"
    ),
    "Decide all corners that you have not decided yourself anew": (
        "Décider de nouveau tous les coins que vous n'avez pas décidés vous-même"
    ),
    "Drag along a line to let one stroke follow it, from line to line or end to end to join": (
        "Glisser le long d'une ligne pour qu'un trait la suive, de ligne à ligne ou de bout à "
        "bout pour joindre"
    ),
    "Drag along a line, from one line to another that meets it at a junction, or from one end to "
    "another.": (
        "Glissez le long d'une ligne, d'une ligne à une autre qui la rencontre à une jonction, "
        "ou d'une extrémité à une autre."
    ),
    "Draw along a line, over at least one junction.": (
        "Dessinez le long d'une ligne, par-dessus au moins une jonction."
    ),
    "How far lines may lie from the path, in pixels of the scan": (
        "À quelle distance du tracé les lignes peuvent être, en pixels de la numérisation"
    ),
    "Let one stroke follow a path; what else meets on its way is decided anew around it": (
        "Faire suivre un tracé par un trait ; ce qu'il rencontre en chemin est redécidé autour"
    ),
    "Nobody looked for corners; trace again with Pen Lifts above -1.": (
        "Personne n'a cherché les coins ; vectorisez de nouveau avec Levers de plume au-dessus "
        "de -1."
    ),
    "Only two lines that meet at one junction, or two ends, can be joined.": (
        "Seules deux lignes qui se rencontrent à une jonction, ou deux extrémités, peuvent être "
        "jointes."
    ),
    "Path": "Tracé",
    "Radius": "Rayon",
    "Route Along Path": "Router le long d'un tracé",
    "Set Pen Lifts": "Régler les levers de plume",
    "Swipe to Cut": "Balayer pour couper",
    "The swipe crosses no stroke.": "Le balayage ne croise aucun trait.",
    "Where the cut runs, in pixels of the scan": "Où passe la coupe, en pixels de la numérisation",
    "Where the stroke is to run, in pixels of the scan": (
        "Où le trait doit passer, en pixels de la numérisation"
    ),
    "{count} strokes": "{count} traits",
    "Swipe across strokes to cut them there; a click on a line ends it at its junction": (
        "Balayer en travers des traits pour les couper là ; un clic sur une ligne l'arrête à sa "
        "jonction"
    ),
    "Click a junction to choose among its alternatives\n"
    "Drag along a line to let one stroke follow it; from line to line or end to end to join\n"
    "Ctrl-drag or Alt-drag across strokes to cut them\n"
    "Ctrl-click or Alt-click a line to end it at its junction\n"
    "Shift-drag around junctions to accept them; with Ctrl, too, a box": (
        "Cliquer une jonction pour choisir parmi ses possibilités\n"
        "Glisser le long d'une ligne pour qu'un trait la suive ; de ligne à ligne ou de bout à "
        "bout pour joindre\n"
        "Ctrl-glisser ou Alt-glisser en travers des traits pour les couper\n"
        "Ctrl-clic ou Alt-clic sur une ligne pour l'arrêter à sa jonction\n"
        "Maj-glisser autour de jonctions pour les accepter ; avec Ctrl aussi, un cadre"
    ),
    "Accept Inside": "Accepter à l'intérieur",
    "Box": "Cadre",
    "Draw a box instead": "Dessiner plutôt un cadre",
    "Draw around junctions to accept them as they are": (
        "Entourer des jonctions pour les accepter telles quelles"
    ),
    "Lasso to Accept": "Lasso pour accepter",
    "Lock every junction inside an outline as it is": (
        "Verrouiller telle quelle chaque jonction à l'intérieur d'un contour"
    ),
    "No open junction lies inside.": "Aucune jonction ouverte n'est à l'intérieur.",
    "The outline, in pixels of the scan": "Le contour, en pixels de la numérisation",
    "{number} of {all}, {long} long strokes left, {settled} settled by your decisions: digit or "
    "click decides, Enter accepts, S decides all that are alike, Space skips, Backspace goes "
    "back, Esc leaves": (
        "{number} sur {all}, {long} longs traits restants, {settled} réglées par vos décisions : "
        "chiffre ou clic décide, Entrée accepte, S décide toutes les semblables, Espace passe, "
        "Retour arrière revient, Échap quitte"
    ),
    "Active Layer": "Calque actif",
    "As Found": "Comme trouvés",
    "As by Hand": "Comme à la main",
    "As the lines were found on the page": "Comme les lignes ont été trouvées sur la page",
    "Do nothing if the drawing has these settings already": (
        "Ne rien faire si le dessin a déjà ces réglages"
    ),
    "In which order and direction the strokes are drawn": (
        "Dans quel ordre et quelle direction les traits sont dessinés"
    ),
    "Live": "En direct",
    "Long outlines first, from left to right and top to bottom, one neighborhood after the "
    "other; for the Build modifier": (
        "Les longs contours d'abord, de gauche à droite et de haut en bas, un voisinage après "
        "l'autre ; pour le modificateur Construction"
    ),
    "Nobody noted which picture this was; trace it as a new object.": (
        "Personne n'a noté quelle image c'était ; vectorisez-la comme nouvel objet."
    ),
    "Show the settings in the sidebar that this drawing was traced with": (
        "Montrer dans le panneau latéral les réglages avec lesquels ce dessin a été vectorisé"
    ),
    "Stroke Order": "Ordre des traits",
    "The Grease Pencil object has no layer; add one to trace into.": (
        "L'objet crayon gras n'a pas de calque ; ajoutez-en un où vectoriser."
    ),
    "The active layer of the active Grease Pencil object, with its active material; what is "
    "there stays": (
        "Le calque actif de l'objet crayon gras actif, avec son matériau actif ; ce qui s'y "
        "trouve reste"
    ),
    "The drawing was deleted meanwhile.": "Le dessin a été supprimé entre-temps.",
    "There is no file {path}; put it back, or trace the picture as a new object.": (
        "Il n'y a pas de fichier {path} ; remettez-le, ou vectorisez l'image comme nouvel objet."
    ),
    "The layer {name!r} is locked; unlock it to trace into it.": (
        "Le calque {name!r} est verrouillé ; déverrouillez-le pour y vectoriser."
    ),
    "The layer {name!r} is locked; unlock it to trace again.": (
        "Le calque {name!r} est verrouillé ; déverrouillez-le pour vectoriser de nouveau."
    ),
    "Trace Again": "Vectoriser de nouveau",
    "Trace again by itself when a setting changes": (
        "Vectoriser de nouveau tout seul quand un réglage change"
    ),
    "Trace the picture of this drawing again with other settings; decisions and changes stay": (
        "Vectoriser de nouveau l'image de ce dessin avec d'autres réglages ; décisions et "
        "changements restent"
    ),
    "Use Its Settings": "Utiliser ses réglages",
    "{count} decisions have no place any more": "{count} décisions n'ont plus de place",
    "{count} that you changed stay": "{count} que vous avez changés restent",
    "Go to the next or previous keyframe that has doubtful junctions": (
        "Aller à l'image clé suivante ou précédente qui a des jonctions douteuses"
    ),
    "Next or Previous Doubtful Keyframe": "Image clé douteuse suivante ou précédente",
    "Which way along the timeline": "Dans quel sens de la ligne de temps",
    "The next doubtful keyframe": "L'image clé douteuse suivante",
    "The doubtful keyframe before": "L'image clé douteuse précédente",
    "{doubts} doubts on {some} of {all} keyframes": (
        "{doubts} doutes sur {some} images clés de {all}"
    ),
    "No other keyframe has doubtful junctions.": (
        "Aucune autre image clé n'a de jonctions douteuses."
    ),
    # sentences of the engine
    "Traced as light lines on dark; if the ink is dark, try --polarity dark.": (
        "Tracé comme lignes claires sur fond sombre ; si l'encre est sombre, essayer "
        "--polarity dark."
    ),
    "{0} of the ink is not in the drawing; try --provider classical, or a smaller "
    "--min-length where dots and specks are missing.": (
        "{0} de l'encre manque dans le dessin ; essayer --provider classical, ou un "
        "--min-length plus petit là où manquent des points."
    ),
    "{0} of the length of the strokes runs over bare paper; raise --min-length, or set "
    "--pen-width.": (
        "{0} de la longueur des traits passe sur du papier vierge ; augmenter --min-length "
        "ou régler --pen-width."
    ),
    "Taken for a rough drawing: its {0} pencil strokes say {1} lines.": (
        "Pris pour un brouillon : ses {0} traits de crayon disent {1} lignes."
    ),
    "No pencil strokes of these lines run beside each other.": (
        "Aucun trait de crayon de ces lignes ne court à côté d’un autre."
    ),
    "The pencil strokes of a bundle are one line or two.": (
        "Les traits de crayon d’un faisceau font une ligne ou deux."
    ),
    "This drawing does not know what its lines were made of; trace the picture again.": (
        "Ce dessin ne sait pas de quoi ses lignes sont faites ; vectorisez l’image à nouveau."
    ),
    "This stroke ends there already.": "Ce trait s'arrête déjà là.",
    "To join, two different ends of strokes are needed.": (
        "Pour joindre, il faut deux extrémités différentes."
    ),
    "Only ends can be joined; cut the stroke that goes on there first.": (
        "Seules des extrémités peuvent être jointes ; couper d'abord le trait qui y continue."
    ),
    "Only ends that meet, or that hang on nothing, can be joined.": (
        "Seules des extrémités qui se touchent, ou libres, peuvent être jointes."
    ),
    "{0} filled shapes were left out.": "{0} formes pleines ont été omises.",
    "What lies beyond the sheet was left out: {0} of the picture.": (
        "Ce qui dépasse de la feuille a été omis : {0} de l'image."
    ),
    "What shows through from the back was left out: {0} of the ink.": (
        "Ce qui transparaît du verso a été omis : {0} de l'encre."
    ),
    "The sheet was not straightened: its four corners are not sure.": (
        "La feuille n'a pas été redressée : ses quatre coins ne sont pas sûrs."
    ),
    "The sheet was straightened: its corners were {0}° askew.": (
        "La feuille a été redressée : ses coins étaient de travers de {0}°."
    ),
    (
        "The picture has white areas and is not of centerlines, thin white lines on black; "
        "choose another --provider."
    ): (
        "L'image a des aplats blancs : ce ne sont pas des lignes médianes, fines et blanches sur "
        "noir ; choisissez un autre --provider."
    ),
    "Printed rules were left out.": "Les lignes imprimées ont été omises.",
    "Left out as no part of the drawing: {0}.": "Omis, car ne fait pas partie du dessin : {0}.",
    "dark borders of the scan": "bords sombres du scan",
    "{0} punched holes": "{0} perforations",
    "{0} registration marks": "{0} repères",
    "There are no peg holes or registration marks on {0}; trace it without aligning.": (
        "Pas de trous de barre à tenons ni de repères sur {0} ; tracer sans aligner."
    ),
    "Screentone was left out: {0} of the page.": "La trame a été omise : {0} de la page.",
    "{0} is damaged; give a whole {1} file.": "{0} est endommagé ; donner un fichier {1} entier.",
    "{0} is not a picture of a kind that is read; give {1}.": (
        "{0} n'est pas une image d'un type lu ; donner {1}."
    ),
    "{0} is {1}, which is not read; {2}.": "{0} est au format {1}, qui n'est pas lu : {2}.",
    "save it as PNG or TIFF first": "l'enregistrer d'abord en PNG ou TIFF",
    "save its pages as PNG or TIFF first, at 300 dpi (pdftoppm -r 300 -png does it)": (
        "enregistrer d'abord ses pages en PNG ou TIFF à 300 dpi (pdftoppm -r 300 -png le fait)"
    ),
    "save it as PNG or JPEG first; a phone can also be set to take JPEG": (
        "l'enregistrer d'abord en PNG ou JPEG ; un téléphone peut aussi être réglé sur JPEG"
    ),
    "{0} is {1}; give an image file (or - for a pipe).": "{0} est {1} ; donner un fichier image.",
    "a folder": "un dossier",
    "no file": "pas un fichier",
    "There is no file {0}; check the path.": "Il n'y a pas de fichier {0} ; vérifier le chemin.",
    "Can't read {0}: {1}.": "Impossible de lire {0} : {1}.",
    "{0} can't be the name of a file.": "{0} ne peut pas être un nom de fichier.",
    "{0} is too large to be read; scale it down to at most 20,000 px a side.": (
        "{0} est trop grand pour être lu ; réduire à 20 000 px par côté au plus."
    ),
    "{0} is only {1} x {2} px; give a picture of at least {3} x {4} px.": (
        "{0} ne fait que {1} x {2} px ; donner une image d'au moins {3} x {4} px."
    ),
    "{0} is {1} x {2} px; scale it down to at most {3} px a side.": (
        "{0} fait {1} x {2} px ; réduire à {3} px par côté au plus."
    ),
    "{0} holds values that aren't numbers; replace the NaN first.": (
        "{0} contient des valeurs qui ne sont pas des nombres ; remplacer d'abord les NaN."
    ),
    "The picture is black all over; scan the page again, or choose polarity 'light' if "
    "it is an empty blackboard.": (
        "L'image est entièrement noire ; scanner la page à nouveau, ou choisir --polarity "
        "light pour un tableau vide."
    ),
    "{0} says it has {1} images; it is damaged.": "{0} dit avoir {1} images ; il est endommagé.",
    "{0} has no image {1} that can be read.": "{0} n'a pas d'image {1} lisible.",
    "{0} is not a movie that can be read.": "{0} n'est pas une vidéo lisible.",
    "the PSD holds no flattened picture; save it with 'Maximize Compatibility', or as PNG.": (
        "le PSD ne contient pas d'image aplatie ; l'enregistrer avec « Maximiser la "
        "compatibilité », ou en PNG."
    ),
    "The weights of the centerline network ({0}) are missing; reinstall Involute, or "
    "choose the classical provider.": (
        "Les poids du réseau des lignes ({0}) manquent ; réinstaller Involute, ou choisir "
        "--provider classical."
    ),
    "Found no GPU that torch can use; choose the device 'auto' or 'cpu'.": (
        "Aucun GPU utilisable par torch ; choisir --device auto ou --device cpu."
    ),
    "Can't read the weights in {0}.": "Impossible de lire les poids dans {0}.",
    "The weights of the routing network are missing or damaged.": (
        "Les poids du réseau des jonctions manquent ou sont endommagés."
    ),
    "The names {0} and {1} are not of one sequence; give the files of one sequence.": (
        "Les noms {0} et {1} ne sont pas d'une même séquence ; donner les fichiers d'une séquence."
    ),
    "The names {0} and {1} differ in more than one number; give the files of one sequence.": (
        "Les noms {0} et {1} diffèrent par plus d'un nombre ; donner les fichiers d'une séquence."
    ),
    "{0} and {1} are both drawing {2}; give the files of one sequence.": (
        "{0} et {1} sont tous deux le dessin {2} ; donner les fichiers d'une séquence."
    ),
    "Frame {0} is beyond what a timeline holds ({1}); choose another start or step.": (
        "L'image {0} dépasse ce que contient une timeline ({1}) ; choisir un autre début ou pas."
    ),
    "{0} declares entities; save it as plain SVG first.": (
        "{0} déclare des entités ; l'enregistrer d'abord en SVG simple."
    ),
    "There is no line in {0}; pictures inside of an SVG are not read.": (
        "Il n'y a pas de ligne dans {0} ; les images d'un SVG ne sont pas lues."
    ),
    "{0} isn't an SVG that can be read ({1}); save it anew.": (
        "{0} n'est pas un SVG lisible ({1}) ; l'enregistrer à nouveau."
    ),
    "Frame {frame}:  {count} doubts": "Image {frame} :  {count} doutes",
    "Most to Review": "Le plus à vérifier",
    "Go to this keyframe": "Aller à cette image clé",
    "Go to Keyframe": "Aller à l'image clé",
    "Number of the frame": "Numéro de l'image",
    "Trace the picture, or the picture file, that is in the clipboard": (
        "Tracer l'image, ou le fichier image, du presse-papiers"
    ),
    "Trace from Clipboard": "Tracer depuis le presse-papiers",
    "Drawing from Clipboard": "Dessin du presse-papiers",
    "Blender sees no picture in the clipboard; save it as a file, and drop that on the viewport.": (
        "Blender ne voit pas d'image dans le presse-papiers ; l'enregistrer dans un fichier "
        "et le déposer sur la vue."
    ),
    # frames
    "Frame": "Image",
    # small parts
    "Small Parts": "Petites parties",
    "Put what hangs together and is smaller than this many pen widths, such as "
    "lettering, on layers of its own; 0 doesn't": (
        "Placer ce qui se tient et qui est plus petit que tant de largeurs de plume, comme "
        "du lettrage, sur des calques à part ; 0 ne le fait pas"
    ),
    # a part of a page
    "Drag a box over the scan to see what the settings do there; each change shows at once": (
        "Tracer un cadre sur le scan pour voir ce que font les réglages ; chaque changement "
        "se montre aussitôt"
    ),
    "Try on a Part": "Essayer sur une partie",
    "Drag a box over the scan, or click it; Esc leaves": (
        "Tracer un cadre sur le scan, ou cliquer dessus ; Échap annule"
    ),
    "Drag a box over the picture.": "Tracer un cadre sur l'image.",
    "Select an image Empty, or a drawing that was traced.": (
        "Sélectionner un Empty image, ou un dessin vectorisé."
    ),
    "The picture isn't as large as what you see of it; trace it as a new object.": (
        "L'image n'a pas la taille de ce qu'on en voit ; la vectoriser dans un nouvel objet."
    ),
    "The lines of an SVG are taken as they are; there is no scan.": (
        "Les lignes d'un SVG sont prises telles quelles ; il n'y a pas de scan."
    ),
    "Trace a part of the picture with the settings of the sidebar, to see what they do": (
        "Vectoriser une partie de l'image avec les réglages de la barre latérale, pour voir "
        "ce qu'ils font"
    ),
    "Trace a Part": "Vectoriser une partie",
    "Left, top, right and bottom of the part, in pixels of the scan; the part that is "
    "shown already, if it isn't given": (
        "Gauche, haut, droite et bas de la partie, en pixels du scan ; sans cela, la partie "
        "déjà montrée"
    ),
    "Take the traced part away; nothing of it stays": (
        "Enlever la partie vectorisée ; il n'en reste rien"
    ),
    "Remove": "Enlever",
    "Make a Grease Pencil object of the traced part": (
        "Faire un objet Grease Pencil de la partie vectorisée"
    ),
    "Keep as Object": "Garder comme objet",
    "Part: {count} strokes": "Partie : {count} traits",
    # paper
    "Show the picture, paled and on paper, behind the strokes that were traced from it": (
        "Montrer l'image, pâlie et sur papier, derrière les traits vectorisés"
    ),
    "Paper": "Papier",
}
