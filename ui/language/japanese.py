"""Japanese texts of the interface by their English ones; places in {braces} stay as they are."""

from __future__ import annotations

TEXTS = {
    # pencil and its lines
    "Merge to One Line": "一本の線に統合",
    "Make one line of the selected strokes, in the middle of them; pencil strokes stay": (
        "選択したストロークの中央に一本の線を作ります。鉛筆のストロークは残ります"
    ),
    "Split into Pencil Strokes": "鉛筆のストロークに分割",
    "Put the pencil strokes that say a line in its place, for all selected lines": (
        "選択した線を、元になった鉛筆のストロークに置き換えます"
    ),
    "Select two or more strokes that are one line.": (
        "一本の線になるストロークを二つ以上選択してください。"
    ),
    "Select lines that were made of pencil strokes.": (
        "鉛筆のストロークから作られた線を選択してください。"
    ),
    "Trace Drawing": "線画をトレース",
    "Turn a scanned drawing into Grease Pencil strokes that run straight through junctions": (
        "スキャンした線画を、交点をまっすぐ通り抜けるグリースペンシルのストロークに変換します"
    ),
    "File": "ファイル",
    "Picture to trace; empty for the image given below or the active image Empty": (
        "トレースする画像。空なら下で指定した画像、またはアクティブな画像エンプティ"
    ),
    "Image": "画像",
    "Name of the image data-block to trace": "トレースする画像データブロックの名前",
    "Target": "ターゲット",
    "Where the strokes go": "ストロークの作成先",
    "New Object": "新規オブジェクト",
    "A Grease Pencil object per drawing": "線画ごとにグリースペンシルオブジェクトを1つ作成",
    "Active Object": "アクティブオブジェクト",
    "A keyframe of the active Grease Pencil object": (
        "アクティブなグリースペンシルオブジェクトのキーフレーム"
    ),
    "Trace scanned drawings from files as Grease Pencil strokes": (
        "ファイルにあるスキャン線画をグリースペンシルのストロークとしてトレースします"
    ),
    "Trace Scanned Drawings": "スキャン線画をトレース",
    "Trace {name}": "{name} をトレース",
    "Trace What {name} Plays": "{name} が再生するものをトレース",
    "Trace Files...": "ファイルをトレース...",
    "Trace Sequence...": "連番をトレース...",
    "Trace as Grease Pencil": "グリースペンシルとしてトレース",
    "Scanned Drawing as Grease Pencil (Involute)": "スキャン線画をグリースペンシルへ (Involute)",
    "Drawing Sequence as Grease Pencil (Involute)": "線画の連番をグリースペンシルへ (Involute)",
    "Scanned Drawing...": "スキャン線画...",
    "Drawing Sequence...": "線画の連番...",
    "Trace as Keyframes (Involute)": "キーフレームとしてトレース (Involute)",
    "Trace as Strokes (Involute)": "ストロークとしてトレース (Involute)",
    "Cancel": "キャンセル",
    "Stop the trace that is running; nothing in the scene changes": (
        "実行中のトレースを中止します。シーンは何も変わりません"
    ),
    "{stage}, {percent} % (Esc cancels)": "{stage}、{percent} % (Esc で中止)",
    "Reading the picture": "画像を読み込み中",
    "Looking for solid blacks": "ベタ塗りを検出中",
    "Finding the lines": "線を検出中",
    "Finding the junctions": "交点を検出中",
    "Routing the junctions": "交点の経路を決定中",
    "Drawing the strokes": "ストロークを作成中",
    "Comparing with the ink": "インクと照合中",
    "{done} of {count} frames": "{count} フレーム中 {done} フレーム",
    "Result": "結果",
    "{strokes:,} strokes, {solids:,} solids, {seconds:.1f} s": (
        "ストローク {strokes:,}、ベタ {solids:,}、{seconds:.1f} 秒"
    ),
    "{junctions:,} junctions, {bundles:,} bundles, {doubtful:,} doubtful": (
        "交点 {junctions:,}、束 {bundles:,}、疑わしいもの {doubtful:,}"
    ),
    (
        "{strokes} strokes, {junctions} junctions and {bundles} bundles "
        "({doubtful} doubtful), {seconds:.1f} s"
    ): (
        "ストローク {strokes}、交点 {junctions}、束 {bundles}"
        "（疑わしいもの {doubtful}）、{seconds:.1f} 秒"
    ),
    "{junctions:,} junctions, {doubtful:,} doubtful": (
        "交点 {junctions:,}、疑わしい交点 {doubtful:,}"
    ),
    "{strokes} strokes, {junctions} junctions ({doubtful} doubtful), {seconds:.1f} s": (
        "ストローク {strokes}、交点 {junctions} (疑わしい交点 {doubtful})、{seconds:.1f} 秒"
    ),
    "Another trace is running; wait for it or cancel it.": (
        "別のトレースを実行中です。終わるのを待つか、中止してください。"
    ),
    "Tracing was cancelled.": "トレースを中止しました。",
    "There is nothing to trace.": "トレースするものがありません。",
    "There are no lines in the picture.": "画像に線がありません。",
    "There is no image {name!r} in this file.": "このファイルに画像 {name!r} はありません。",
    "The image {name!r} has no pixels; reload it or choose another.": (
        "画像 {name!r} にピクセルがありません。読み込み直すか、別の画像を選んでください。"
    ),
    "Choose a picture file, or select an Empty that shows an image.": (
        "画像ファイルを選ぶか、画像を表示するエンプティを選択してください。"
    ),
    "Make a Grease Pencil object of this file the active one.": (
        "このファイルのグリースペンシルオブジェクトをアクティブにしてください。"
    ),
    "There is not enough memory for a picture of this size.": (
        "この大きさの画像にはメモリが足りません。"
    ),
    "What the Drawing Is": "線画の種類",
    "How Clean": "クリーンアップ",
    "How Many Points": "ポイントの数",
    "Whether every line is drawn once or by many pencil strokes": (
        "各線が一度で描かれているか、何本もの鉛筆の線で描かれているか"
    ),
    "Rough where many lines run beside themselves": "多くの線が重なって走るところはラフとします",
    "Clean": "清書",
    "Every line is drawn once": "各線は一度で描かれています",
    "Rough": "ラフ",
    "Many pencil strokes say one line: find that line": (
        "何本もの鉛筆の線が一本の線を表します。その線を見つけます"
    ),
    "Lines": "線",
    "Which side of the picture is ink": "画像のどちら側がインクか",
    "Find out from the picture": "画像から判断します",
    "Dark on Light": "明るい地に暗い線",
    "Ink or pencil on paper": "紙にインクまたは鉛筆",
    "Light on Dark": "暗い地に明るい線",
    "Chalk, blueprints, inverted scans": "チョーク、青写真、反転したスキャン",
    "Pen Width": "ペンの幅",
    "Usual width of a line in pixels of the picture; 0 measures it": (
        "線の普通の幅 (画像のピクセル)。0 なら測定します"
    ),
    "Line Finder": "線の検出",
    "What finds the centres of the lines": "線の中心を見つける方法",
    "The trained network when it is there, else the ridge filter": (
        "学習済みネットワークがあればそれを、なければ稜線フィルターを使います"
    ),
    "Network": "ネットワーク",
    "Trained on pencil, ink, chalk and bad scans": (
        "鉛筆、インク、チョーク、状態の悪いスキャンで学習済み"
    ),
    "Grain": "粒状感",
    "From how far the page is looked at, so that grainy lines are whole": (
        "粗い線が途切れないよう、ページをどの距離から見るか"
    ),
    "Closely, and where soft lines are torn from afar as well; the simpler drawing is kept": (
        "近くから見て、柔らかい線が途切れるときは遠くからも見ます"
    ),
    "As close as the pen is wide: ink, markers, clean pencil": (
        "ペンの太さに合わせた距離：インク、マーカー、きれいな鉛筆"
    ),
    "At 0.7 of that size: soft pencil, crayon": "その 0.7 倍の大きさ：柔らかい鉛筆、クレヨン",
    "At 0.55 of that size: charcoal, chalk, rough paper": (
        "その 0.55 倍の大きさ：木炭、チョーク、粗い紙"
    ),
    "Fine": "細かい",
    "Medium": "中くらい",
    "Coarse": "粗い",
    "The lines are grainy: traced from farther away (--grain {0}).": (
        "線が粗いため、遠くから見てトレースしました（--grain {0}）。"
    ),
    "Coarsest": "最も粗い",
    "At 0.4 of that size: what falls to shreds even so": (
        "その 0.4 倍の大きさ：それでも途切れる線"
    ),
    "Lean Network": "軽量ネットワーク",
    "Smaller, in three quarters of the time; cuts grainy lines more": (
        "小さく、時間は約 4 分の 3。ざらついた線は途切れやすい"
    ),
    "Ridge Filter": "稜線フィルター",
    "No learning; for very clean lines": "学習なし。とてもきれいな線向け",
    "Picture Is Centerlines": "画像が中心線そのもの",
    "Thin white lines on black, made elsewhere": "別の方法で作った、黒地に白い細線",
    "Solid Blacks": "ベタ塗り",
    "Turn areas of solid ink into fills instead of tracing them as lines": (
        "塗りつぶされた部分を線としてトレースせず、塗りにします"
    ),
    "Ink Colors": "インクの色",
    "Give every ink its own layer and material; off draws all lines in black": (
        "インクごとにレイヤーとマテリアルを分けます。オフならすべての線が黒になります"
    ),
    "Ignore Inks": "無視するインク",
    "Inks that are not traced, such as a blue construction pencil": (
        "青い下描き鉛筆など、トレースしないインク"
    ),
    "None": "なし",
    "Don't trace lines of this color": "この色の線をトレースしません",
    "Red": "赤",
    "Orange": "オレンジ",
    "Yellow": "黄",
    "Green": "緑",
    "Cyan": "シアン",
    "Blue": "青",
    "Purple": "紫",
    "Pink": "ピンク",
    "Gray": "グレー",
    "Solid Width": "ベタの幅",
    "Leave Out Rules": "罫線を除く",
    "Don't trace the printed lines of ruled and squared paper": (
        "罫紙や方眼紙の印刷された線をトレースしません"
    ),
    "Leave Out Screentone": "スクリーントーンを除く",
    "Don't trace areas of evenly set dots, such as the tones of a comic": (
        "漫画のトーンのように等間隔の網点の部分をトレースしません"
    ),
    "Leave Out Surroundings": "周囲を除く",
    "Don't trace what lies beyond the sheet in a photograph: cloth, a desk, a finger": (
        "写真で紙の外に写っているもの (布、机、指など) をトレースしません"
    ),
    "Straighten Sheet": "用紙の歪みを補正",
    "Take the perspective out of a photographed sheet, as seen from straight above": (
        "写真に撮った用紙の遠近の歪みを除き、真上から見たようにします"
    ),
    "Leave Out the Back": "裏面を除く",
    "Don't trace what shows through from the back of the sheet, paler and softer": (
        "用紙の裏から透けて見える、薄くてぼけたものをトレースしません"
    ),
    "Lines wider than this, in pixels of the picture, are solid areas; 0 finds out from the pen": (
        "これより太い線 (画像のピクセル) はベタとみなします。0 ならペンから判断します"
    ),
    "Keep Dots": "点を残す",
    "Keep dots of full ink about as wide as the pen, which are no specks": (
        "ペンとほぼ同じ太さの濃い点を、ごみとみなさずに残します"
    ),
    "Join Dashes": "破線をつなぐ",
    "Make one stroke of a dashed or dotted line, and note how it is dashed": (
        "破線や点線を1本のストロークにし、その間隔を記録します"
    ),
    "Opacity": "不透明度",
    "How opaque the strokes are": "ストロークの不透明度",
    "Solid": "不透明",
    "Solid for ink, as drawn for pencil": "インクは不透明、鉛筆は描かれたとおり",
    "Every stroke is opaque": "すべてのストロークが不透明",
    "As Drawn": "描かれたとおり",
    "As strong as the line on the paper": "紙の上の線と同じ濃さ",
    "Width Scale": "幅の倍率",
    "Make the strokes this many times as wide as the lines on the paper": (
        "紙の上の線の幅に対するストロークの幅の倍率"
    ),
    "Even Width": "幅を均一に",
    "Give each stroke one width all along, that of its line on average": (
        "各ストロークを、その線の平均の幅で均一にします"
    ),
    "Leave Out Marks": "マークを除く",
    "Don't trace scan borders, punched holes and registration marks": (
        "スキャンの縁、パンチ穴、トンボをトレースしません"
    ),
    "Fill Regions": "領域を塗る",
    "Fill the closed regions between the lines, on a layer below": (
        "線で閉じた領域を、下のレイヤーで塗ります"
    ),
    "Specks": "ごみ取り",
    "Drop lone strokes shorter than this many pen widths": (
        "孤立した線のうち、ペンの幅のこの倍数より短いものを捨てます"
    ),
    "Smoothing": "スムージング",
    "0 keeps every wobble of the hand, 1 is very smooth": (
        "0 で手の震えをそのまま残し、1 でとても滑らかになります"
    ),
    "Pen Lifts": "ペンの離れ",
    "Where strokes end though only two lines meet: -1 nowhere, 0 where it looks as if the pen "
    "was lifted, 1 wherever it may have been": (
        "2本の線だけが出会う所でストロークが終わるか: -1 は終わらない、0 はペンが離れたと見える所"
        "、1 は離れた可能性がある所すべて"
    ),
    "Junctions": "交点",
    "What decides which lines continue through a junction": (
        "交点でどの線がどこへ続くかを決める方法"
    ),
    "The trained network when it is there, else geometry": (
        "学習済みネットワークがあればそれを、なければ幾何を使います"
    ),
    "Looks at the whole neighborhood of the junction": "交点の周り全体を見ます",
    "Geometry": "幾何",
    "Looks at direction, curvature and width only": "方向、曲率、幅だけを見ます",
    "Tolerance": "許容誤差",
    "How far a stroke may stray from the traced line, in pixels of the picture; more gives fewer "
    "points": (
        "ストロークがトレースした線から離れてよい距離 (画像のピクセル)。大きいほどポイントが減り"
        "ます"
    ),
    "Curves": "カーブ",
    "What the strokes are made of": "ストロークの構成要素",
    "Points": "ポイント",
    "Plain points, for sculpting and drawing over": "単純なポイント。スカルプトや描き足し向け",
    "Bézier": "ベジエ",
    "Few points with handles": "ハンドル付きの少ないポイント",
    "Device": "デバイス",
    "Where the networks run": "ネットワークを動かす場所",
    "A graphics card when one can be used, else the processor": (
        "使えるならグラフィックカード、そうでなければプロセッサ"
    ),
    "Processor": "プロセッサ",
    "Always works": "いつでも動きます",
    "Graphics Card": "グラフィックカード",
    "Needs PyTorch in Blender's Python": "Blender の Python に PyTorch が必要です",
    "Reset to Defaults": "デフォルトに戻す",
    "Set all trace settings back to the defaults that are in the preferences": (
        "トレースの設定をすべて、プリファレンスのデフォルトに戻します"
    ),
    "Trace Preset": "トレースのプリセット",
    "Trace Presets": "トレースのプリセット一覧",
    "Add or remove a preset of the trace settings": (
        "トレース設定のプリセットを追加または削除します"
    ),
    "Place": "配置",
    "Where a new drawing stands; on an image Empty it always lies on the image": (
        "新しい線画を置く場所。画像エンプティでは常に画像の上に重なります"
    ),
    "Front View": "前面ビュー",
    "Automatic": "自動",
    "Fit to the camera while you look through it, else front view": (
        "カメラビューならカメラに合わせ、それ以外は前面ビュー"
    ),
    "Upright at the world's origin, before what stands there": (
        "ワールド原点に立て、そこにあるものの手前に置きます"
    ),
    "Scan Behind": "背後にスキャン",
    "Where It Goes": "置き場所",
    "Scan": "スキャン",
    "Fit to Camera": "カメラに合わせる",
    "Fill the view of the scene's camera, facing it": (
        "シーンのカメラの視野いっぱいに、正対させます"
    ),
    "Drawing Plane": "描画平面",
    "As the scene's Stroke Placement and Drawing Plane say": (
        "シーンの「ストロークの配置」と「描画平面」に従います"
    ),
    "Pixels per Metre": "1メートルのピクセル数",
    "Size of a new drawing; 0 makes it 2 metres tall. Fit to Camera ignores it": (
        "新しい線画の大きさ。0 なら高さ2メートル。「カメラに合わせる」では無視されます"
    ),
    "There is no camera in the scene to fit to; add one, or place it else.": (
        "合わせるカメラがシーンにありません。カメラを追加するか、別の配置を選んでください。"
    ),
    "Trace Sequence": "連番をトレース",
    "Turn numbered drawings into keyframes of one Grease Pencil object, in the background": (
        "番号付きの線画を、バックグラウンドで1つのグリースペンシルオブジェクトのキーフレームにし"
        "ます"
    ),
    "Trace Drawing Sequence": "線画の連番をトレース",
    "Choose a folder of numbered drawings, or some of them, and trace them as keyframes": (
        "番号付き線画のフォルダー、またはその一部を選び、キーフレームとしてトレースします"
    ),
    "Start At": "開始位置",
    "Put the first drawing at a frame of your choice instead of its own number": (
        "最初の線画を、その番号ではなく指定したフレームに置きます"
    ),
    "Start Frame": "開始フレーム",
    "Frame of the first drawing": "最初の線画のフレーム",
    "Step": "ステップ",
    "Frames from one number to the next; 2 animates on twos": (
        "番号1つあたりのフレーム数。2 なら2コマ打ち"
    ),
    "Align by Peg Holes": "タップ穴で位置合わせ",
    "Bring all pages to where the peg holes or registration marks of the first lie": (
        "すべてのページを、最初のページのタップ穴やトンボの位置に合わせます"
    ),
    "Steady Strokes": "安定したストローク",
    "Give neighboring frames the same order and direction of strokes, so that Interpolate pairs "
    "them rightly": (
        "隣り合うフレームでストロークの順番と向きを揃え、補間で正しく対応するようにします"
    ),
    "Processes": "プロセス数",
    "Drawings traced at the same time; 0 uses every processor core": (
        "同時にトレースする線画の数。0 ならすべてのコアを使います"
    ),
    "Folder": "フォルダー",
    "Folder of numbered drawings; empty for what the active image Empty plays": (
        "番号付き線画のフォルダー。空ならアクティブな画像エンプティが再生するもの"
    ),
    "Only What Changed": "変わったものだけ",
    "Fill the active object; keyframes whose drawing has not changed stay as they are, with all "
    "that was done to them": (
        "アクティブオブジェクトを更新します。線画が変わっていないキーフレームは、手を加えたものも"
        "そのまま残ります"
    ),
    "Choose a folder of drawings, or select an Empty that plays images or a movie.": (
        "線画のフォルダーを選ぶか、連番画像や動画を再生するエンプティを選択してください。"
    ),
    "Make the Grease Pencil object of the sequence the active one.": (
        "連番のグリースペンシルオブジェクトをアクティブにしてください。"
    ),
    "None of the frames could be traced.": "どのフレームもトレースできませんでした。",
    "Frame {frame}": "フレーム {frame}",
    "{count} keyframes": "キーフレーム {count}",
    "{count} kept": "{count} はそのまま",
    "{count} frames failed": "{count} フレームが失敗",
    "then cancelled": "その後中止",
    "There is no folder {path}; check the path.": (
        "フォルダー {path} がありません。パスを確かめてください。"
    ),
    "There is no picture in {path}; choose another folder.": (
        "{path} に画像がありません。別のフォルダーを選んでください。"
    ),
    "{name} plays no frame; set its Frames to more than 0.": (
        "{name} は1フレームも再生しません。フレーム数を 0 より大きくしてください。"
    ),
    "There is no folder {path}; find the images again.": (
        "フォルダー {path} がありません。画像を探し直してください。"
    ),
    "There is no file {path}; find the images again.": (
        "ファイル {path} がありません。画像を探し直してください。"
    ),
    "Sort": "並べ替え",
    "Order of the list": "リストの順番",
    "Doubt": "疑わしさ",
    "The most doubtful first": "疑わしいものから",
    "From the top of the page to the bottom": "ページの上から下へ",
    "Doubtful": "疑わしい",
    "List doubtful junctions only": "疑わしい交点だけを表示します",
    "Unlocked": "未ロック",
    "Leave out junctions that you have fixed": "自分で決めた交点を除きます",
    "How many lines meet": "出会う線の数",
    "Any": "すべて",
    "Any number of lines": "線の数は問いません",
    "Three lines meet": "3本の線が出会います",
    "Four lines meet": "4本の線が出会います",
    "Five or more lines meet": "5本以上の線が出会います",
    "Page": "ページ",
    "Page of the list": "リストのページ",
    "Page of {count}": "ページ (全 {count})",
    "{some} of {all}": "{all} 中 {some}",
    "{count} lines": "{count} 本の線",
    "Bundle": "束",
    "One line": "一本の線",
    "Two lines": "二本の線",
    "Pencil strokes beside each other: one line or two": (
        "並んだ鉛筆のストローク：一本の線か二本の線か"
    ),
    "No junction passes the filters": "条件に合う交点がありません",
    "No junction passes the filters.": "条件に合う交点がありません。",
    "Previous": "前へ",
    "Next": "次へ",
    "Direction": "方向",
    "Which way along the list": "リストのどちらへ進むか",
    "The next junction of the list": "リストの次の交点",
    "The junction before in the list": "リストの前の交点",
    "Next or Previous Junction": "次または前の交点",
    "Go to the next or previous junction of the list": "リストの次または前の交点へ移動します",
    "Go to Junction": "交点へ移動",
    "Look at this junction": "この交点を見ます",
    "Move View": "ビューを動かす",
    "Bring the junction to the middle of the view": "交点をビューの中央に表示します",
    "Above": "これ以上",
    "Accept {count}": "{count} 個を承認",
    "Stroke Colors": "ストロークの色分け",
    "Strokes": "ストローク",
    "Show every stroke in a color of its own, with its ends marked": (
        "ストロークを1本ずつ別の色で、端に印を付けて表示します"
    ),
    "Stroke Width": "ストロークの幅",
    "Width of a stroke that is shown in a color of its own, in pixels": (
        "色分け表示するストロークの幅 (ピクセル)"
    ),
    "One of the colors that tell strokes apart": "ストロークを見分ける色の1つ",
    "Stroke Color 1": "ストロークの色 1",
    "Stroke Color 2": "ストロークの色 2",
    "Stroke Color 3": "ストロークの色 3",
    "Stroke Color 4": "ストロークの色 4",
    "Stroke Color 5": "ストロークの色 5",
    "Stroke Color 6": "ストロークの色 6",
    "Accept Certain Junctions": "確かな交点を承認",
    "Lock every junction that is at least this certain": "これ以上確かな交点をすべてロックします",
    "Certainty": "確かさ",
    "Least probability of the routing in force": "現在の経路の最低の確率",
    "{count} junctions accepted": "{count} 個の交点を承認しました",
    "Ask Again": "再判定",
    "Route all junctions that are not locked again, given what you have fixed": (
        "決めたことを踏まえて、ロックされていない交点をすべて決め直します"
    ),
    "{count} junctions changed": "{count} 個の交点が変わりました",
    "Current Junction": "現在の交点",
    "Junction": "交点",
    "Number of the junction": "交点の番号",
    "Number of the junction; -1 is the current one": "交点の番号。-1 は現在の交点",
    "Alternative": "候補",
    "Which alternative": "どの候補か",
    "Which alternative, the most probable is 0": "どの候補か。最も確からしいものが 0",
    "{lines} ends": "{lines} は終わり",
    "{lines} end": "{lines} は終わり",
    "Lock Junction": "交点をロック",
    "Lock the junction: it counts as certain, and Ask Again learns from it; or unlock it": (
        "交点をロックします。確かなものとして扱われ、再判定の手がかりになります。ロック中なら解除"
        "します"
    ),
    "Lock or Unlock": "ロックまたは解除",
    "Preview Alternative": "候補をプレビュー",
    "Show this alternative in the viewport without applying it; again to stop": (
        "この候補を適用せずにビューポートに表示します。もう一度押すとやめます"
    ),
    "Reroute Junction": "交点の経路を変更",
    "Let the lines continue through the junction in this way; only they change": (
        "交点で線がこのように続くようにします。変わるのはその線だけです"
    ),
    "Choose in Viewport": "ビューポートで選ぶ",
    "Choose Routing": "経路を選ぶ",
    "Show the alternatives of a junction as cards: point to preview, click to apply": (
        "交点の候補をカードで表示します。指すとプレビュー、クリックで適用"
    ),
    "Point at a card to preview, click or Enter to apply, wheel or arrows for the next, L locks, "
    "Esc leaves": (
        "カードを指すとプレビュー、クリックか Enter で適用、ホイールか矢印で次へ、L でロック、Esc"
        " で終了"
    ),
    "Pick": "ピック",
    "Take the junction under the mouse instead of the current one": (
        "現在の交点ではなくマウスの下の交点を使います"
    ),
    "By Hand": "手動",
    "Join Lines": "線をつなぐ",
    "Let one of these lines continue in the other; what they continued in before ends here": (
        "一方の線がもう一方へ続くようにします。それまで続いていた先はここで終わります"
    ),
    "First": "1本目",
    "Second": "2本目",
    "Number of a half-branch": "半枝の番号",
    "Number of the other half-branch": "もう一方の半枝の番号",
    "Ends": "終わる",
    "Separate Lines": "線を切り離す",
    "Separate All Lines": "すべての線を切り離す",
    "End a line at its junction, or all lines of the current junction": (
        "線をその交点で終わらせます。または現在の交点のすべての線を終わらせます"
    ),
    "Line": "線",
    "Number of the half-branch; -1 separates all": "半枝の番号。-1 ならすべて切り離します",
    "Drag to Join": "ドラッグでつなぐ",
    "Choose a junction first.": "先に交点を選んでください。",
    "This junction has {count} alternatives.": "この交点の候補は {count} 個です。",
    "Select a drawing that Involute has traced": "Involute がトレースした線画を選択してください",
    "This drawing is linked from another file; make it local to change it.": (
        "この線画は別のファイルからリンクされています。変更するにはローカル化してください。"
    ),
    "This drawing was not traced by Involute.": (
        "この線画は Involute がトレースしたものではありません。"
    ),
    "A newer Involute traced this drawing; update the extension.": (
        "この線画は新しいバージョンの Involute がトレースしました。拡張機能を更新してください。"
    ),
    "A stroke at this junction was changed so much that its ends can't be told; nothing was "
    "changed.": (
        "この交点のストロークは大きく変更され、端が分からなくなっています。何も変更していません。"
    ),
    "Drawing": "線画",
    "The traced drawing that is looked at": "見ているトレース済みの線画",
    "The current junction": "現在の交点",
    "Preview": "プレビュー",
    "The alternative that is shown but not applied": "表示しているが適用していない候補",
    "Choosing": "選択中",
    "The cards of the alternatives are shown": "候補のカードを表示しています",
    "Junction Overlay": "交点オーバーレイ",
    "Show junctions in the viewport, colored by doubt": (
        "交点を疑わしさで色分けしてビューポートに表示します"
    ),
    "Defaults": "デフォルト",
    "Trace settings that Reset to Defaults brings back": "「デフォルトに戻す」で戻るトレース設定",
    "Certain": "確か",
    "Color of junctions that are certain": "確かな交点の色",
    "Color of the most doubtful junctions": "最も疑わしい交点の色",
    "Locked": "ロック済み",
    "Color of junctions that you have fixed": "自分で決めた交点の色",
    "Ring Size": "リングの大きさ",
    "Radius of a certain junction's ring, in pen widths": (
        "確かな交点のリングの半径 (ペンの幅の倍数)"
    ),
    "Default Trace Settings": "トレース設定のデフォルト",
    "Keys in the 3D Viewport": "3Dビューポートのキー",
    "Networks": "ネットワーク",
    "Line finder": "線の検出",
    "Lean line finder": "軽量な線の検出",
    "Junction router": "交点の経路",
    "not installed: the method without learning is used": (
        "未インストール: 学習なしの方法を使います"
    ),
    "Choose one picture file or several.": "画像ファイルを1つ以上選んでください。",
    "Review Junctions": "交点をレビュー",
    "Decide the doubtful junctions one after the other, those first where most depends on it": (
        "疑わしい交点を、影響の大きいものから順に決めていきます"
    ),
    "No junction is doubtful any more.": "疑わしい交点はもうありません。",
    "A review needs a 3D viewport.": "レビューには3Dビューポートが必要です。",
    "Cost": "コスト",
    "Doubt times the length of stroke that another answer changes": (
        "疑わしさ × 別の答えで変わるストロークの長さ"
    ),
    "Use Preset": "プリセットを使う",
    "Set all trace settings to what suits a kind of drawing": (
        "トレースの設定をすべて、線画の種類に合わせます"
    ),
    "Preset": "プリセット",
    "What kind of drawing it is": "線画の種類",
    "Ink": "インク",
    "Pen drawings on paper; the defaults": "紙に描いたペン画。デフォルトの設定",
    "Pencil": "鉛筆",
    "Soft lines of changing darkness, crumbs left out; no solid blacks": (
        "濃さの変わる柔らかい線。細かいかすは除き、ベタはなし"
    ),
    "Brush and Marker": "筆とマーカー",
    "Broad, swelling lines in few points, thick places not taken for solids": (
        "太く膨らむ線を少ないポイントで。太い所をベタとみなしません"
    ),
    "Blueprint": "青写真",
    "Light lines on dark paper, all in one ink, corners kept sharp": (
        "暗い紙に明るい線。インクは1色、角は鋭いまま"
    ),
    "Binarised Animation Lines": "二値化した動画線",
    "Hard black and colored lines without grey, closed regions filled": (
        "グレーのない黒と色の硬い線。閉じた領域を塗ります"
    ),
    "Comic Page": "漫画のページ",
    "Ink with solid blacks, all in one ink, specks of the print left out": (
        "ベタのあるインク。インクは1色、印刷のごみを除きます"
    ),
    "Next Junction": "次の交点",
    "Previous Junction": "前の交点",
    "This drawing has no junctions any more: what was stored of them is damaged. Its strokes "
    "stay as they are.": (
        "この線画にはもう交点がありません。保存されていた交点の情報が壊れています。ストロークはそ"
        "のまま残ります。"
    ),
    "The strokes at this junction were deleted, or joined by hand; nothing was changed.": (
        "この交点のストロークは削除されたか、手でつながれています。何も変更していません。"
    ),
    "The layer {name!r} is locked; unlock it to reroute.": (
        "レイヤー {name!r} がロックされています。経路を変えるにはロックを解除してください。"
    ),
    "Cut Strokes": "ストロークを切る",
    "Cut the strokes that a path crosses there; the cuts are decisions of yours and stay": (
        "パスが横切る所でストロークを切ります。切った所は自分で決めたものとして残ります"
    ),
    "Decide all corners that you have not decided yourself anew": (
        "自分で決めていない角をすべて決め直します"
    ),
    "Drag along a line to let one stroke follow it, from line to line or end to end to join": (
        "線に沿ってドラッグすると1本のストロークがそれに従います。線から線、端から端へならつなぎ"
        "ます"
    ),
    "Drag along a line, from one line to another that meets it at a junction, or from one end to "
    "another.": "線に沿って、交点で出会う別の線まで、または端から別の端までドラッグしてください。",
    "Draw along a line, over at least one junction.": (
        "1つ以上の交点を通って、線に沿って描いてください。"
    ),
    "How far lines may lie from the path, in pixels of the scan": (
        "線がパスから離れていてよい距離 (スキャンのピクセル)"
    ),
    "Let one stroke follow a path; what else meets on its way is decided anew around it": (
        "1本のストロークをパスに従わせます。途中で出会うほかの線は、それに合わせて決め直します"
    ),
    "Nobody looked for corners; trace again with Pen Lifts above -1.": (
        "角は調べられていません。「ペンの離れ」を -1 より大きくしてトレースし直してください。"
    ),
    "Only two lines that meet at one junction, or two ends, can be joined.": (
        "つなげるのは、1つの交点で出会う2本の線か、2つの端だけです。"
    ),
    "Path": "パス",
    "Radius": "半径",
    "Route Along Path": "パスに沿って経路を決める",
    "Set Pen Lifts": "ペンの離れを設定",
    "Swipe to Cut": "スワイプで切る",
    "The swipe crosses no stroke.": "スワイプはどのストロークとも交わりません。",
    "Where the cut runs, in pixels of the scan": "切る位置 (スキャンのピクセル)",
    "Where the stroke is to run, in pixels of the scan": "ストロークの通り道 (スキャンのピクセル)",
    "{count} strokes": "ストローク {count}",
    "Swipe across strokes to cut them there; a click on a line ends it at its junction": (
        "ストロークを横切ってスワイプするとそこで切ります。線をクリックするとその交点で終わらせます"
    ),
    "Click a junction to choose among its alternatives\n"
    "Drag along a line to let one stroke follow it; from line to line or end to end to join\n"
    "Ctrl-drag or Alt-drag across strokes to cut them\n"
    "Ctrl-click or Alt-click a line to end it at its junction\n"
    "Shift-drag around junctions to accept them; with Ctrl, too, a box": (
        "交点をクリックして候補から選ぶ\n"
        "線に沿ってドラッグすると1本のストロークが従う。線から線、端から端へならつなぐ\n"
        "Ctrl または Alt を押しながらストロークを横切ってドラッグすると切る\n"
        "Ctrl または Alt を押しながら線をクリックすると、その交点で終わらせる\n"
        "Shift を押しながら交点を囲むと承認。Ctrl も押すとボックス"
    ),
    "Accept Inside": "内側を承認",
    "Box": "ボックス",
    "Draw a box instead": "代わりにボックスを描きます",
    "Draw around junctions to accept them as they are": "囲んだ交点をそのまま承認します",
    "Lasso to Accept": "投げ縄で承認",
    "Lock every junction inside an outline as it is": (
        "輪郭の内側の交点をすべて、そのままロックします"
    ),
    "No open junction lies inside.": "内側に未決定の交点がありません。",
    "The outline, in pixels of the scan": "輪郭 (スキャンのピクセル)",
    "{number} of {all}, {long} long strokes left, {settled} settled by your decisions: digit or "
    "click decides, Enter accepts, S decides all that are alike, Space skips, Backspace goes "
    "back, Esc leaves": (
        "{all} 中 {number}、長いストローク残り {long}、決定により解決 {settled}: 数字かクリックで"
        "決定、Enter で承認、S で似たものをすべて決定、Space で飛ばす、Backspace で戻る、Esc で終"
        "了"
    ),
    "Active Layer": "アクティブレイヤー",
    "As Found": "見つけた順",
    "As by Hand": "手描きの順",
    "As the lines were found on the page": "ページ上で線が見つかった順番",
    "Do nothing if the drawing has these settings already": "線画がすでにこの設定なら何もしません",
    "In which order and direction the strokes are drawn": "ストロークを描く順番と向き",
    "Live": "ライブ",
    "Long outlines first, from left to right and top to bottom, one neighborhood after the "
    "other; for the Build modifier": (
        "長い輪郭から、左から右、上から下へ、近い所をまとめて順に。ビルドモディファイアー向け"
    ),
    "Nobody noted which picture this was; trace it as a new object.": (
        "元の画像が記録されていません。新しいオブジェクトとしてトレースしてください。"
    ),
    "Show the settings in the sidebar that this drawing was traced with": (
        "この線画をトレースした設定をサイドバーに表示します"
    ),
    "Stroke Order": "ストロークの順番",
    "The Grease Pencil object has no layer; add one to trace into.": (
        "グリースペンシルオブジェクトにレイヤーがありません。トレース先のレイヤーを追加してくださ"
        "い。"
    ),
    "The active layer of the active Grease Pencil object, with its active material; what is "
    "there stays": (
        "アクティブなグリースペンシルオブジェクトのアクティブレイヤーに、アクティブマテリアルで。"
        "すでにあるものは残ります"
    ),
    "The drawing was deleted meanwhile.": "線画はその間に削除されました。",
    "There is no file {path}; put it back, or trace the picture as a new object.": (
        "ファイル {path} がありません。元に戻すか、画像を新しいオブジェクトとしてトレースしてくだ"
        "さい。"
    ),
    "The layer {name!r} is locked; unlock it to trace into it.": (
        "レイヤー {name!r} がロックされています。トレースするにはロックを解除してください。"
    ),
    "The layer {name!r} is locked; unlock it to trace again.": (
        "レイヤー {name!r} がロックされています。トレースし直すにはロックを解除してください。"
    ),
    "Trace Again": "トレースし直す",
    "Trace again by itself when a setting changes": "設定が変わったら自動でトレースし直します",
    "Trace the picture of this drawing again with other settings; decisions and changes stay": (
        "この線画の元画像を別の設定でトレースし直します。決定と手直しは残ります"
    ),
    "Use Its Settings": "この線画の設定を使う",
    "{count} decisions have no place any more": "{count} 個の決定は行き場がなくなりました",
    "{count} that you changed stay": "手直しした {count} 本はそのまま",
    "Go to the next or previous keyframe that has doubtful junctions": (
        "疑わしい交点のある次または前のキーフレームへ移動します"
    ),
    "Next or Previous Doubtful Keyframe": "次または前の疑わしいキーフレーム",
    "Which way along the timeline": "タイムラインのどちらへ進むか",
    "The next doubtful keyframe": "次の疑わしいキーフレーム",
    "The doubtful keyframe before": "前の疑わしいキーフレーム",
    "{doubts} doubts on {some} of {all} keyframes": (
        "疑わしい交点 {doubts} ({all} 中 {some} キーフレーム)"
    ),
    "No other keyframe has doubtful junctions.": (
        "疑わしい交点のあるキーフレームはほかにありません。"
    ),
    # sentences of the engine
    "Traced as light lines on dark; if the ink is dark, try --polarity dark.": (
        "暗い地の明るい線としてトレースしました。インクが暗い場合は --polarity "
        "dark を試してください。"
    ),
    "{0} of the ink is not in the drawing; try --provider classical, or a smaller "
    "--min-length where dots and specks are missing.": (
        "インクの {0} が描画にありません。--provider classical "
        "を試すか、点や斑点が欠けている場合は --min-length "
        "を小さくしてください。"
    ),
    "{0} of the length of the strokes runs over bare paper; raise --min-length, or set "
    "--pen-width.": (
        "ストロークの長さの {0} が白紙の上を通っています。--min-length "
        "を上げるか --pen-width を設定してください。"
    ),
    "Taken for a rough drawing: its {0} pencil strokes say {1} lines.": (
        "ラフと判断しました。鉛筆の {0} ストロークは {1} 本の線を表しています。"
    ),
    "No pencil strokes of these lines run beside each other.": (
        "これらの線の鉛筆のストロークは並んでいません。"
    ),
    "The pencil strokes of a bundle are one line or two.": (
        "束の鉛筆のストロークは、一本か二本の線です。"
    ),
    "This drawing does not know what its lines were made of; trace the picture again.": (
        "この描画には線の元になったものが残っていません。画像をもう一度トレースしてください。"
    ),
    "This stroke ends there already.": ("このストロークはすでにそこで終わっています。"),
    "To join, two different ends of strokes are needed.": ("つなぐには異なる2つの端が必要です。"),
    "Only ends can be joined; cut the stroke that goes on there first.": (
        "つなげるのは端だけです。そこで続いているストロークを先に切ってください。"
    ),
    "Only ends that meet, or that hang on nothing, can be joined.": (
        "つなげるのは、出会っている端か何にもつながっていない端だけです。"
    ),
    "{0} filled shapes were left out.": ("塗りつぶし図形 {0} 個を除きました。"),
    "What lies beyond the sheet was left out: {0} of the picture.": (
        "紙の外にあるものを除きました: 画像の {0}。"
    ),
    "What shows through from the back was left out: {0} of the ink.": (
        "裏面から透けて見えるものを除きました: インクの {0}。"
    ),
    "The sheet was not straightened: its four corners are not sure.": (
        "用紙を補正しませんでした。四隅がはっきりしません。"
    ),
    "The sheet was straightened: its corners were {0}° askew.": (
        "用紙の歪みを補正しました。角のずれは {0}° でした。"
    ),
    (
        "The picture has white areas and is not of centerlines, thin white lines on black; "
        "choose another --provider."
    ): (
        "画像に白い面があり、黒地に細い白線の中心線画像ではありません。"
        "別の --provider を選んでください。"
    ),
    "Printed rules were left out.": "印刷された罫線を除きました。",
    "Left out as no part of the drawing: {0}.": ("描画の一部ではないため除きました: {0}。"),
    "dark borders of the scan": "スキャンの暗い縁",
    "{0} punched holes": "パンチ穴 {0} 個",
    "{0} registration marks": "トンボ {0} 個",
    "There are no peg holes or registration marks on {0}; trace it without aligning.": (
        "{0} にはタップ穴もトンボもありません。位置合わせなしでトレースしてください。"
    ),
    "Screentone was left out: {0} of the page.": ("スクリーントーンを除きました: ページの {0}。"),
    "{0} is damaged; give a whole {1} file.": (
        "{0} は壊れています。完全な {1} ファイルを指定してください。"
    ),
    "{0} is not a picture of a kind that is read; give {1}.": (
        "{0} は読み込める種類の画像ではありません。{1} を指定してください。"
    ),
    "{0} is {1}, which is not read; {2}.": ("{0} は {1} で、読み込めません: {2}。"),
    "save it as PNG or TIFF first": ("先に PNG か TIFF で保存してください"),
    "save its pages as PNG or TIFF first, at 300 dpi (pdftoppm -r 300 -png does it)": (
        "先にページを 300 dpi の PNG か TIFF で保存してください (pdftoppm -r 300 -png が使えます)"
    ),
    "save it as PNG or JPEG first; a phone can also be set to take JPEG": (
        "先に PNG か JPEG で保存してください。電話の設定を JPEG にすることもできます"
    ),
    "{0} is {1}; give an image file (or - for a pipe).": (
        "{0} は{1}です。画像ファイルを指定してください。"
    ),
    "a folder": "フォルダー",
    "no file": "ファイルではないもの",
    "There is no file {0}; check the path.": (
        "ファイル {0} がありません。パスを確認してください。"
    ),
    "Can't read {0}: {1}.": "{0} を読み込めません: {1}。",
    "{0} can't be the name of a file.": "{0} はファイル名にできません。",
    "{0} is too large to be read; scale it down to at most 20,000 px a side.": (
        "{0} は大きすぎて読み込めません。一辺 20,000 px 以下に縮小してください。"
    ),
    "{0} is only {1} x {2} px; give a picture of at least {3} x {4} px.": (
        "{0} は {1} x {2} px しかありません。{3} x {4} px 以上の画像を指定してください。"
    ),
    "{0} is {1} x {2} px; scale it down to at most {3} px a side.": (
        "{0} は {1} x {2} px です。一辺 {3} px 以下に縮小してください。"
    ),
    "{0} holds values that aren't numbers; replace the NaN first.": (
        "{0} に数でない値があります。先に NaN を置き換えてください。"
    ),
    "The picture is black all over; scan the page again, or choose polarity 'light' if "
    "it is an empty blackboard.": (
        "画像全体が黒です。ページをスキャンし直すか、空の黒板なら --polarity "
        "light を選んでください。"
    ),
    "{0} says it has {1} images; it is damaged.": (
        "{0} には {1} 枚の画像があるとのことですが、壊れています。"
    ),
    "{0} has no image {1} that can be read.": ("{0} に読み込める画像 {1} がありません。"),
    "{0} is not a movie that can be read.": ("{0} は読み込める動画ではありません。"),
    "the PSD holds no flattened picture; save it with 'Maximize Compatibility', or as PNG.": (
        "PSD に統合画像がありません。「互換性を最優先」で、または PNG で保存してください。"
    ),
    "The weights of the centerline network ({0}) are missing; reinstall Involute, or "
    "choose the classical provider.": (
        "線検出ネットワークの重み ({0}) がありません。Involute "
        "を再インストールするか --provider classical を選んでください。"
    ),
    "Found no GPU that torch can use; choose the device 'auto' or 'cpu'.": (
        "torch が使える GPU がありません。--device auto か --device cpu を選んでください。"
    ),
    "Can't read the weights in {0}.": "{0} の重みを読み込めません。",
    "The weights of the routing network are missing or damaged.": (
        "交点ネットワークの重みがないか、壊れています。"
    ),
    "The names {0} and {1} are not of one sequence; give the files of one sequence.": (
        "{0} と {1} は同じ連番ではありません。1つの連番のファイルを指定してください。"
    ),
    "The names {0} and {1} differ in more than one number; give the files of one sequence.": (
        "{0} と {1} は2つ以上の数が違います。1つの連番のファイルを指定してください。"
    ),
    "{0} and {1} are both drawing {2}; give the files of one sequence.": (
        "{0} と {1} はどちらも {2} 番の絵です。1つの連番のファイルを指定してください。"
    ),
    "Frame {0} is beyond what a timeline holds ({1}); choose another start or step.": (
        "フレーム {0} はタイムラインの範囲 ({1}) を超えています。開始かステップを変えてください。"
    ),
    "{0} declares entities; save it as plain SVG first.": (
        "{0} はエンティティを宣言しています。先にプレーン SVG で保存してください。"
    ),
    "There is no line in {0}; pictures inside of an SVG are not read.": (
        "{0} に線がありません。SVG 内の画像は読み込まれません。"
    ),
    "{0} isn't an SVG that can be read ({1}); save it anew.": (
        "{0} は読み込める SVG ではありません ({1})。保存し直してください。"
    ),
    "Frame {frame}:  {count} doubts": ("フレーム {frame}:  疑わしい交点 {count}"),
    "Most to Review": "確認の多いフレーム",
    "Go to this keyframe": "このキーフレームへ移動",
    "Go to Keyframe": "キーフレームへ",
    "Number of the frame": "フレーム番号",
    "Trace the picture, or the picture file, that is in the clipboard": (
        "クリップボードの画像、または画像ファイルをトレース"
    ),
    "Trace from Clipboard": "クリップボードからトレース",
    "Drawing from Clipboard": "クリップボードの描画",
    "Blender sees no picture in the clipboard; save it as a file, and drop that on the viewport.": (
        "Blender "
        "からはクリップボードに画像が見えません。ファイルに保存してビューポートにドロップして"
        "ください。"
    ),
    # frames
    "Frame": "フレーム",
    # small parts
    "Small Parts": "小さな部分",
    "Put what hangs together and is smaller than this many pen widths, such as "
    "lettering, on layers of its own; 0 doesn't": (
        "つながっていてペン幅のこの倍数より小さいもの (文字など) "
        "を別のレイヤーに置く。0 では置かない"
    ),
    # a part of a page
    "Drag a box over the scan to see what the settings do there; each change shows at "
    "once": "スキャン上で枠をドラッグすると、設定の効果がそこに表示される。変更はすぐに反映される",
    "Try on a Part": "一部で試す",
    "Drag a box over the scan, or click it; Esc leaves": (
        "スキャン上で枠をドラッグするかクリック。Esc で中止"
    ),
    "Drag a box over the picture.": "画像の上で枠をドラッグしてください。",
    "Select an image Empty, or a drawing that was traced.": (
        "画像エンプティか、トレースした絵を選択してください。"
    ),
    "The picture isn't as large as what you see of it; trace it as a new object.": (
        "画像の大きさが表示されているものと違います。新しいオブジェクトとしてトレースしてください。"
    ),
    "The lines of an SVG are taken as they are; there is no scan.": (
        "SVG の線はそのまま使われます。スキャンはありません。"
    ),
    "Trace a part of the picture with the settings of the sidebar, to see what they do": (
        "サイドバーの設定で画像の一部をトレースし、その効果を見る"
    ),
    "Trace a Part": "一部をトレース",
    "Left, top, right and bottom of the part, in pixels of the scan; the part that is "
    "shown already, if it isn't given": (
        "一部の左、上、右、下 (スキャンのピクセル)。指定しなければ、すでに表示されている一部"
    ),
    "Take the traced part away; nothing of it stays": ("トレースした一部を取り除く。何も残らない"),
    "Remove": "取り除く",
    "Make a Grease Pencil object of the traced part": (
        "トレースした一部をグリースペンシルオブジェクトにする"
    ),
    "Keep as Object": "オブジェクトとして残す",
    "Part: {count} strokes": "一部: {count} ストローク",
    # paper
    "Show the picture, paled and on paper, behind the strokes that were traced from it": (
        "トレース元の画像を、薄くして紙の上で、ストロークの後ろに表示する"
    ),
    "Paper": "紙",
}
